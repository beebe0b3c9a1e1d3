// SPDX-License-Identifier: BSD-3-Clause
// Sections at planes that the user chose.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "check/check_placed.h"
#include "check/three_numbers.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

/// The parts are cut this much below the plane, so that a face in the plane is always in front of the cut,
/// also where its corners are rounded to either side of the plane.
double shift_m(double size_m) {
  constexpr double kShift_m = 1e-9;  // less than any picture shows
  constexpr double kShare = 1e-12;   // some thousand times the rounding of a double
  return std::max(kShift_m, kShare * size_m);
}

struct CutReach {
  double low_m = 1e300, high_m = -1e300;
  void add(double at_m) {
    low_m = std::min(low_m, at_m);
    high_m = std::max(high_m, at_m);
  }
  [[nodiscard]] double size() const { return high_m - low_m; }
  [[nodiscard]] double middle() const { return 0.5 * (low_m + high_m); }
};

CutReach reachOf(const Mesh& mesh, const Pose& X_WP, const Vec3& n_W) {
  CutReach out;
  for (const Vec3& p : mesh.vertices) out.add(n_W.dot(X_WP * p));
  return out;
}

/// Where the parts are cut, and which parts are.
struct CutPlace {
  double offset_m = 0;
  std::vector<bool> is_cut;
};

std::string millimetres(double length_m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g mm", 1e3 * length_m);
  return text;
}

std::string axisOf(const SectionPlane& plane) {
  for (int axis = 0; axis < 3; ++axis)
    if (plane.n_W == Vec3(Vec3::Unit(axis))) return std::string(1, "xyz"[axis]);
  return "the normal " + plane.name.substr(0, plane.name.find('='));
}

/// Throws LoadError if the plane cuts no part.
CutPlace cutPlace(const SectionPlane& plane, const std::vector<CutReach>& reaches) {
  CutReach all;
  for (const CutReach& part : reaches) {
    all.add(part.low_m);
    all.add(part.high_m);
  }
  CutPlace out;
  out.offset_m = plane.offset_m - shift_m(all.size());
  bool is_any_cut = false;
  for (const CutReach& part : reaches) {
    out.is_cut.push_back(part.low_m < out.offset_m && out.offset_m < part.high_m);
    is_any_cut = is_any_cut || out.is_cut.back();
  }
  if (is_any_cut) return out;
  const bool is_outside = out.offset_m <= all.low_m || out.offset_m >= all.high_m;
  const std::string range =
      "from " + millimetres(all.low_m) + " to " + millimetres(all.high_m) + " along " + axisOf(plane);
  throw LoadError(
      "", "",
      "the section " + plane.name + " cuts no part: " +
          (is_outside ? "the parts reach " + range + "; give a place between"
                      : "it lies in a gap between the parts, which reach " + range + "; give another place"));
}

/// The directions to the right and up as seen along the plane's normal: see PlaneSection.
void orient(const Vec3& n_W, PlaneSection& section) {
  constexpr double kLevel = 0.99;
  const Vec3 near_up = std::abs(n_W.z()) < kLevel ? Vec3::UnitZ() : Vec3::UnitY();
  section.up_W = (near_up - near_up.dot(n_W) * n_W).normalized();
  section.right_W = section.up_W.cross(n_W);
  if (section.right_W.x() < -1e-9) section.right_W = -section.right_W;
}

/// Moves the point (0, 0) of the outlines to their middle.
void centre(PlaneSection& section) {
  if (section.parts.empty()) return;
  std::array<CutReach, 2> reach;
  for (const SectionOutline& part : section.parts)
    for (const auto& chain : part.chains)
      for (const auto& p : chain)
        for (const std::size_t axis : {0U, 1U}) reach[axis].add(p[axis]);
  const std::array middle_m = {reach[0].middle(), reach[1].middle()};
  section.half_m = {0.5 * reach[0].size(), 0.5 * reach[1].size()};
  section.at_W += middle_m[0] * section.right_W + middle_m[1] * section.up_W;
  for (SectionOutline& part : section.parts)
    for (auto& chain : part.chains)
      for (auto& p : chain)
        for (const std::size_t axis : {0U, 1U}) p[axis] -= middle_m[axis];
}

}  // namespace

SectionPlane sectionPlaneFromText(const std::string& text, const std::string& what) {
  const std::size_t at = text.find('=');
  const auto fail = [&](const std::string& found) {
    throw LoadError(what, "",
                    "'" + text + "' " + found +
                        "; write an axis or a normal, and a place with its unit: z=12mm, x=-3mm or "
                        "0:0.7:0.7=12mm");
  };
  if (at == std::string::npos) fail("has no =");
  SectionPlane plane{text, {}, 0};
  const std::string axis = text.substr(0, at);
  if (axis == "x" || axis == "y" || axis == "z")
    plane.n_W = Vec3::Unit(axis[0] - 'x');
  else if (const std::optional<Vec3> normal = threeNumbers(axis))
    plane.n_W = *normal;
  else
    fail("has neither an axis (x, y or z) nor a normal of three numbers before the =");
  const double length = plane.n_W.norm();
  if (!std::isfinite(length) || length < 1e-9) fail("has a normal without a direction");
  plane.n_W /= length;
  plane.offset_m = lengthFromText(text.substr(at + 1), what + " " + text);
  return plane;
}

void requireCut(const SectionPlane& plane, const std::vector<DrawnPart>& parts) {
  std::vector<CutReach> reaches;
  for (const DrawnPart& part : parts) reaches.push_back(reachOf(part.mesh, part.X_WP, plane.n_W));
  cutPlace(plane, reaches);
}

std::vector<PlaneSection> planeSections(const std::vector<PlacedSurface>& parts,
                                        const std::vector<SectionPlane>& planes, const Progress& progress) {
  std::vector<PlaneSection> out;
  for (const SectionPlane& plane : planes) {
    std::vector<CutReach> reaches;
    for (const PlacedSurface& part : parts)
      reaches.push_back(reachOf(part.surface->mesh(), part.X_WP, plane.n_W));
    const CutPlace place = cutPlace(plane, reaches);
    PlaneSection& section = out.emplace_back();
    section.plane = plane;
    section.at_W = place.offset_m * plane.n_W;
    orient(plane.n_W, section);
    CheckedSection cut;  // as large as needed to clip nothing
    cut.at_W = section.at_W;
    cut.right_W = section.right_W;
    cut.up_W = section.up_W;
    for (const PlacedSurface& part : parts)
      cut.half_m = std::max(cut.half_m, (part.box_W.center() - cut.at_W).norm() + part.box_W.size().norm());
    std::vector<SectionOutline> outlines(parts.size());
    forEachOnCores(parts.size(), progress, "drawing sections", [&](std::size_t i) {
      if (place.is_cut[i]) outlines[i] = outlineOf(parts[i], cut);
    });
    for (SectionOutline& outline : outlines)
      if (!outline.chains.empty()) section.parts.push_back(std::move(outline));
    centre(section);
  }
  return out;
}

}  // namespace vps::scenes
