// SPDX-License-Identifier: BSD-3-Clause
// Arrows and balloons over the pictures of an instruction book.
#include <algorithm>
#include <array>
#include <cmath>

#include "files/html.h"
#include "pages/book_pictures.h"

namespace vps::viewer {

namespace {

using Pixel = std::array<double, 2>;

std::string px(double value) {
  return html::format(value, "%.1f");
}

std::string pointList(const std::vector<Pixel>& points) {
  std::string out;
  for (const Pixel& p : points) {
    if (!out.empty()) out += ' ';
    out += px(p[0]);
    out += ',';
    out += px(p[1]);
  }
  return out;
}

double lengthOf(const Pixel& from, const Pixel& to) {
  return std::hypot(to[0] - from[0], to[1] - from[1]);
}

/// An arrow along a chain of points; empty if the chain is too short to be seen.
std::string arrowSvg(std::vector<Pixel> chain) {
  constexpr double kHead_px = 22, kHalfWidth_px = 9, kLeast_px = 8;
  const Pixel tip = chain.back();
  double whole_px = 0;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) whole_px += lengthOf(chain[i], chain[i + 1]);
  if (!(whole_px > kLeast_px)) return {};
  // The head replaces the points that it covers.
  const double head_px = std::min(kHead_px, 0.6 * whole_px);
  while (chain.size() > 1 && lengthOf(chain.back(), tip) < head_px) chain.pop_back();
  const double back_px = lengthOf(chain.back(), tip);
  if (!(back_px > 0)) return {};
  const double ux = (tip[0] - chain.back()[0]) / back_px, uy = (tip[1] - chain.back()[1]) / back_px;
  const Pixel base = {tip[0] - head_px * ux, tip[1] - head_px * uy};
  const double half_px = kHalfWidth_px * head_px / kHead_px;
  const std::vector<Pixel> head = {tip,
                                   {base[0] - half_px * uy, base[1] + half_px * ux},
                                   {base[0] + half_px * uy, base[1] - half_px * ux}};
  chain.push_back(base);
  const std::string line = "<polyline points=\"" + pointList(chain) +
                           "\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" stroke=\"";
  return line + "#fff\" stroke-width=\"8\"/>" + line + "#d9480f\" stroke-width=\"4\"/><polygon points=\"" +
         pointList(head) + "\" fill=\"#d9480f\" stroke=\"#fff\" stroke-width=\"1.5\"/>\n";
}

/// A balloon of a column, before its place is known.
struct PlacedBalloon {
  const BookBalloon* balloon = nullptr;
  Pixel anchor{};
  double y_px = 0;
};

/// Moves the balloons of a column, which are sorted from top to bottom, apart and into the picture.
void spread(std::vector<PlacedBalloon>& column, double radius_px, double spacing_px, int height) {
  double least_px = radius_px + 3;
  for (PlacedBalloon& one : column) {
    one.y_px = std::max(one.anchor[1], least_px);
    least_px = one.y_px + spacing_px;
  }
  double most_px = height - radius_px - 3;
  for (std::size_t i = column.size(); i-- > 0;) {
    column[i].y_px = std::min(column[i].y_px, most_px);
    most_px = column[i].y_px - spacing_px;
  }
}

/// @param edge_px  left or right edge of what is shown; the column stands outside of it, in the picture
std::string columnSvg(std::vector<PlacedBalloon> column, bool is_left, double edge_px, int width,
                      int height) {
  if (column.empty()) return {};
  constexpr double kRadius_px = 17, kGap_px = 6;
  std::ranges::stable_sort(column, {}, [](const PlacedBalloon& one) { return one.anchor[1]; });
  const double room_px = (height - 2 * kGap_px) / static_cast<double>(column.size());
  const double radius_px = std::clamp(0.5 * (room_px - kGap_px), 2.0, kRadius_px);
  spread(column, radius_px, std::min(2 * radius_px + kGap_px, room_px), height);
  constexpr double kBeside_px = 30;
  const double x_px = std::clamp(edge_px + (is_left ? -1 : 1) * (radius_px + kBeside_px), radius_px + kGap_px,
                                 width - radius_px - kGap_px);
  std::string out;
  for (const PlacedBalloon& one : column) {
    const std::string x = px(x_px), y = px(one.y_px), to_x = px(one.anchor[0]), to_y = px(one.anchor[1]);
    out += "<g class=\"balloon\"><title>" + escapeHtml(one.balloon->name) + "</title><line x1=\"" + x +
           "\" y1=\"" + y + "\" x2=\"" + to_x + "\" y2=\"" + to_y +
           "\" stroke=\"#222\" stroke-width=\"1.2\"/><circle cx=\"" + to_x + "\" cy=\"" + to_y +
           "\" r=\"3\" fill=\"#222\"/><circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"" + px(radius_px) +
           "\" fill=\"" + (one.balloon->is_moved ? "#cfe0ff" : "#fff") +
           "\" stroke=\"#222\" stroke-width=\"1.5\"/><text x=\"" + x + "\" y=\"" +
           px(one.y_px + 0.36 * radius_px) + "\" font-size=\"" + px(1.05 * radius_px) +
           "\" text-anchor=\"middle\">" + std::to_string(one.balloon->number) + "</text></g>\n";
  }
  return out;
}

}  // namespace

std::string pictureSvg(const BookPicture& picture, const std::string& image, int width, int height) {
  const std::string size =
      "width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) + "\"";
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"book\" viewBox=\"0 0 " +
                    std::to_string(width) + " " + std::to_string(height) + "\" " + size +
                    " font-family=\"DejaVu Sans, sans-serif\">\n";
  if (!image.empty()) out += "<image " + size + " href=\"" + image + "\"/>\n";
  for (const std::vector<Vec3>& arrow_W : picture.arrows_W) {
    std::vector<Pixel> chain;
    for (const Vec3& p_W : arrow_W) chain.push_back(picture.camera.project(p_W, width, height));
    if (!chain.empty()) out += arrowSvg(std::move(chain));
  }
  std::vector<PlacedBalloon> left, right;
  for (const BookBalloon& balloon : picture.balloons) {
    const Pixel at = picture.camera.project(balloon.at_W, width, height);
    // A part in place may lie outside of the picture.
    if (!(at[0] >= 0 && at[0] <= width && at[1] >= 0 && at[1] <= height)) continue;
    (at[0] < 0.5 * width ? left : right).push_back({&balloon, at, 0});
  }
  double left_px = width, right_px = 0;
  for (const Vec3& corner_W : picture.corners_W) {
    const double x_px = picture.camera.project(corner_W, width, height)[0];
    left_px = std::min(left_px, x_px);
    right_px = std::max(right_px, x_px);
  }
  if (!(left_px < right_px)) left_px = 0, right_px = width;
  return out + columnSvg(std::move(left), true, left_px, width, height) +
         columnSvg(std::move(right), false, right_px, width, height) + "</svg>\n";
}

}  // namespace vps::viewer
