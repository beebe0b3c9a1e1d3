// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the sections at planes that the user chose (vps check --section).
#include <algorithm>
#include <array>
#include <cmath>

#include "files/html.h"
#include "pages/section_shapes.h"
#include "pages/svg.h"
#include "vps_scenes/fits/check_fields.h"

namespace vps::viewer {

namespace {

constexpr double kPlaneWidth = 912, kPlaneTallest = 700;  // [px]
constexpr double kKeyRow = 18, kKeysInRow = 3;
constexpr const char* kOverlapFill = "#e0202f";

/// A light colour for each part. Neighbours in the list differ in hue, since the golden angle spreads any
/// number of hues evenly.
std::string partFill(std::size_t i) {
  constexpr double kGoldenAngle_deg = 137.508, kFirst_deg = 210;
  const double hue_deg = std::fmod(kFirst_deg + kGoldenAngle_deg * static_cast<double>(i), 360);
  return "hsl(" + html::format(hue_deg, "%.0f") + ",45%," + (i % 2 == 0 ? "76%" : "66%") + ")";
}

const scenes::SectionOutline* outlineNamed(const scenes::PlaneSection& section, const std::string& part) {
  const auto found = std::ranges::find(section.parts, part, &scenes::SectionOutline::part);
  return found == section.parts.end() ? nullptr : &*found;
}

/// The areas that overlapping parts share, in red; empty if the plane cuts none.
std::string overlapsIn(const scenes::CheckResult& result, const scenes::PlaneSection& section,
                       const svg::Window& window, const std::string& id) {
  std::string out;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    if (!isOverlapping(result.pairs[i])) continue;
    const scenes::SectionOutline *a = outlineNamed(section, result.pairs[i].a),
                                 *b = outlineNamed(section, result.pairs[i].b);
    if (a == nullptr || b == nullptr) continue;
    const std::string clip = "p" + id + "o" + std::to_string(i);
    out += "<clipPath id=\"" + clip + "\"><path d=\"" + svg::pathOf(*b, window) +
           "\" clip-rule=\"evenodd\"/></clipPath>\n<g clip-path=\"url(#" + clip + ")\">" +
           svg::filled(svg::pathOf(*a, window), kOverlapFill) + "</g>\n";
  }
  return out;
}

/// The window that shows all outlines with a margin, as wide as the page unless that would be too tall.
svg::Window windowOf(const scenes::PlaneSection& section) {
  constexpr double kMargin = 1.04, kFlattest = 0.15;
  const double right_m = kMargin * section.half_m[0], up_m = kMargin * section.half_m[1];
  svg::Window window{.left = 1, .width = kPlaneWidth};
  window.half_m = std::max({right_m, up_m * kPlaneWidth / kPlaneTallest, 1e-9});
  window.height = kPlaneWidth * std::clamp(up_m / window.half_m, kFlattest, kPlaneTallest / kPlaneWidth);
  return window;
}

std::string drawn(const scenes::CheckResult& result, const scenes::PlaneSection& section,
                  const std::string& id) {
  const svg::Window window = windowOf(section);
  std::string shapes;
  for (std::size_t i = 0; i < section.parts.size(); ++i) {
    const std::string name = escapeHtml(section.parts[i].part);
    shapes += "<g><title>" + name + "</title>" +
              svg::filled(svg::pathOf(section.parts[i], window), partFill(i), "data-part=\"" + name + "\"") +
              "</g>\n";
  }
  const std::string overlaps = overlapsIn(result, section, window, id);
  const std::size_t keys = section.parts.size() + (overlaps.empty() ? 0 : 1);
  const double first_key = svg::kTop + window.height + svg::kFoot + 10;
  const double height = first_key + kKeyRow * std::ceil(static_cast<double>(keys) / kKeysInRow);
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" data-section=\"" + escapeHtml(section.plane.name) +
      "\" viewBox=\"0 0 " + html::format(kPlaneWidth + 2, "%.0f") + " " + html::format(height, "%.0f") +
      "\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n" + shapes + overlaps +
      svg::rectangle(window.left, svg::kTop, window.width, window.height, "fill=\"none\" stroke=\"#999\"") +
      svg::scaleBar(window);
  for (std::size_t i = 0; i < keys; ++i) {
    const double column = std::fmod(static_cast<double>(i), kKeysInRow),
                 row = std::floor(static_cast<double>(i) / kKeysInRow);
    const bool is_part = i < section.parts.size();
    out += svg::key(3 + column * kPlaneWidth / kKeysInRow, first_key + row * kKeyRow,
                    (is_part ? partFill(i) : kOverlapFill).c_str(),
                    is_part ? escapeHtml(section.parts[i].part) : "overlap");
  }
  return out + "</svg>\n";
}

/// The direction in words, for "x to the right": "x", "-y" or components.
std::string axisText(const Vec3& d) {
  for (int axis = 0; axis < 3; ++axis)
    if (d.cwiseAbs()[axis] > 1 - 1e-9) return std::string(d[axis] < 0 ? "−" : "") + "xyz"[axis];
  return "(" + html::format(d.x(), "%.3g") + ", " + html::format(d.y(), "%.3g") + ", " +
         html::format(d.z(), "%.3g") + ")";
}

std::string planeCaption(const scenes::PlaneSection& section) {
  std::string out = "Section <b>" + escapeHtml(section.plane.name) + "</b> through " +
                    std::to_string(section.parts.size()) + (section.parts.size() == 1 ? " part" : " parts") +
                    "; " + axisText(section.right_W) + " points to the right, " + axisText(section.up_W) +
                    " upwards. The middle of the picture is at (" +
                    html::format(1e3 * section.at_W.x(), "%.2f") + ", " +
                    html::format(1e3 * section.at_W.y(), "%.2f") + ", " +
                    html::format(1e3 * section.at_W.z(), "%.2f") + ") mm.";
  std::string open;
  for (const scenes::SectionOutline& part : section.parts)
    if (part.is_open) open += (open.empty() ? "" : ", ") + escapeHtml(part.part);
  if (!open.empty())
    out += " Surfaces with holes here, whose outlines are closed by straight lines: " + open + ".";
  return out;
}

}  // namespace

std::string planeSectionPictures(const scenes::CheckResult& result) {
  if (result.plane_sections.empty()) return "";
  std::string out =
      "<h2>Sections at given planes</h2>\n<p>All parts, cut through their meshes. Faces that lie in the "
      "plane "
      "belong to the side that is cut away. Red areas are shared by parts that overlap.</p>\n";
  for (std::size_t i = 0; i < result.plane_sections.size(); ++i)
    out += "<figure class=\"section\">" + drawn(result, result.plane_sections[i], std::to_string(i)) +
           "<figcaption>" + planeCaption(result.plane_sections[i]) + "</figcaption></figure>\n";
  return out;
}

}  // namespace vps::viewer
