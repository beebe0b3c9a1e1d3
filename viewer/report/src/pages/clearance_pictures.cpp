// SPDX-License-Identifier: BSD-3-Clause
#include "pages/clearance_pictures.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include "files/base64.h"
#include "files/html.h"
#include "files/length_text.h"
#include "vps_scenes/cad/srgb.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr std::array<std::array<double, 3>, 4> kRamp = {
    {{0.86, 0.10, 0.08}, {0.98, 0.80, 0.10}, {0.20, 0.65, 0.25}, {0.15, 0.35, 0.85}}};
constexpr std::array<double, 3> kOverlap = {0.85, 0.0, 0.75}, kFar = {0.80, 0.81, 0.82};
constexpr double kDecades = 3;

std::array<float, 3> toLinear(const std::array<double, 3>& srgb) {
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(scenes::linearFromSrgb(srgb[k]));
  return out;
}

std::string legend(double near_m) {
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 44\" width=\"640\" "
      "font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n";
  const auto box = [&](double x, double width, const std::array<double, 3>& c) {
    out += "<rect x=\"" + format(x, "%.1f") + "\" y=\"2\" width=\"" + format(width, "%.1f") +
           "\" height=\"18\" fill=\"rgb(" + format(255 * c[0], "%.0f") + "," + format(255 * c[1], "%.0f") +
           "," + format(255 * c[2], "%.0f") + ")\"/>\n";
  };
  const auto words = [&](double x, const std::string& text) {
    out += "<text x=\"" + format(x, "%.0f") + "\" y=\"36\" text-anchor=\"middle\">" + text + "</text>\n";
  };
  box(2, 70, kOverlap);
  words(37, "overlap");
  constexpr int kSteps = 140;
  for (int i = 0; i < kSteps; ++i)
    box(90 + 3 * i, 3.2, clearanceColor(near_m * std::pow(10, kDecades * ((i + 0.5) / kSteps - 1)), near_m));
  for (int i = 0; i <= 3; ++i)
    words(90 + 140.0 * i, (i == 0 ? "≤ " : "") + lengthText(near_m * std::pow(10, i - kDecades)));
  box(560, 70, kFar);
  words(595, "farther");
  return out + "</svg>\n";
}

std::string picture(Renderer& renderer, std::size_t part, const Box& box_W, const Vec3& to_viewer) {
  scenes::Snapshot snapshot;
  snapshot.bodies.push_back({part, Pose(), scenes::BodyRole::Mounted});
  DrawOptions options;
  options.width = 560;
  options.height = 420;
  options.show_ground = options.show_legend = options.highlight_hand = false;
  const Image image = renderer.render(snapshot, frameScene(box_W, to_viewer, 0.5, 4.0 / 3), options);
  return "<img alt=\"\" style=\"width:49%;display:inline-block\" src=\"" + pngInText(pngBytes(image)) + "\">";
}

std::string pictures(const scenes::CheckResult& result) {
  RenderScene scene;
  std::vector<std::vector<std::array<float, 3>>> colors;
  colors.reserve(result.maps.size());
  for (const scenes::ClearanceMap& map : result.maps) {
    auto& of_map = colors.emplace_back();
    for (const double distance_m : map.distance_m)
      of_map.push_back(toLinear(clearanceColor(distance_m, result.near_m)));
    scene.push_back({&map.mesh_W, {1, 1, 1}, false, Pose(), &of_map});
  }
  Renderer renderer(scene);
  std::string out;
  for (std::size_t i = 0; i < result.maps.size(); ++i) {
    const scenes::ClearanceMap& map = result.maps[i];
    const double least_m = *std::ranges::min_element(map.distance_m);
    const Box box_W = bounds(map.mesh_W);
    out +=
        "<figure class=\"section\">" + picture(renderer, i, box_W, Vec3(0.75, -1.25, 0.85)) +
        picture(renderer, i, box_W, Vec3(-0.75, 1.25, -0.85)) + "<figcaption><b>" + escapeHtml(map.part) +
        "</b>, from the front, right and above, and from the other side. At the points that were measured " +
        (least_m < 0 ? "it is up to " + format(-1e6 * least_m, "%.2f µm") + " in another part."
                     : "it is nearest to another part by " + format(1e6 * least_m, "%.2f µm") + ".") +
        "</figcaption></figure>\n";
  }
  return out;
}

}  // namespace

std::array<double, 3> clearanceColor(double distance_m, double near_m) {
  // The sign of a point on a common face is that of rounding.
  if (distance_m < -1e-5 * near_m) return kOverlap;
  if (distance_m >= near_m) return kFar;
  const double share = std::clamp(1 + std::log10(std::max(distance_m, 1e-300) / near_m) / kDecades, 0.0, 1.0);
  const double at = share * (kRamp.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = kRamp[i][k] + (at - static_cast<double>(i)) * (kRamp[i + 1][k] - kRamp[i][k]);
  return out;
}

std::string clearancePictures(const scenes::CheckResult& result) {
  if (result.maps.empty()) return "";
  std::string out =
      "<h2>Clearance on the surfaces</h2>\n<p>The distance of each point of a part's surface from "
      "the nearest other part, which is not drawn.</p>\n" +
      legend(result.near_m);
  try {
    return out + pictures(result);
  } catch (const std::exception& error) {  // no EGL or OpenGL here
    return out + "<p class=\"note\">These pictures are missing: " + escapeHtml(error.what()) + "</p>\n";
  }
}

}  // namespace vps::viewer
