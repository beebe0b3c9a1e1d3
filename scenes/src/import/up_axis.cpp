// SPDX-License-Identifier: BSD-3-Clause
// Which axis of a file is up.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "import/readers.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr double kGround = 0.005;  // of the height: feet of one foundation are drawn that even
constexpr double kLevel = 0.99;    // of a facet's normal
constexpr double kBetter = 0.02;   // of the side: less decides nothing, and z is kept

}  // namespace

void import::turnUp(ImportedCad& cad, const Vec3& axis) {
  const Pose turn(Quat::FromTwoVectors(axis, Vec3::UnitZ()).toRotationMatrix(), Vec3::Zero());
  for (ImportedPart& part : cad.parts) part.X_WP = turn * part.X_WP;
}

namespace {

/// How well the parts stand with an axis up: the share of their box's side below that is flat and lies on
/// the ground, less half of that of the side above, for a lid is flat as well.
double standOf(const ImportedCad& cad, int axis) {
  Box box;
  for (const ImportedPart& part : cad.parts)
    for (const Vec3& p : part.mesh.vertices) box.add(part.X_WP * p);
  const double slab_m = kGround * box.size()[axis];
  double below_m2 = 0, above_m2 = 0;
  for (const ImportedPart& part : cad.parts)
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const Vec3 p = part.X_WP * part.mesh.vertices[a], q = part.X_WP * part.mesh.vertices[b],
                 r = part.X_WP * part.mesh.vertices[c];
      const Vec3 area_m2 = 0.5 * (q - p).cross(r - p);
      if (std::abs(area_m2[axis]) < kLevel * area_m2.norm()) continue;
      if (std::max({p[axis], q[axis], r[axis]}) < box.min[axis] + slab_m && area_m2[axis] < 0)
        below_m2 -= area_m2[axis];
      if (std::min({p[axis], q[axis], r[axis]}) > box.max[axis] - slab_m && area_m2[axis] > 0)
        above_m2 += area_m2[axis];
    }
  const double side_m2 = box.size()[(axis + 1) % 3] * box.size()[(axis + 2) % 3];
  return side_m2 > 0 ? (below_m2 - 0.5 * above_m2) / side_m2 : 0;
}

}  // namespace

void import::guessUp(ImportedCad& cad) {
  const double y = standOf(cad, 1), z = standOf(cad, 2);
  const bool is_y = y > z + kBetter;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%c is taken to be up: of the side below, %.0f %% is flat and on the ground, and %.0f %% with %c up; "
      "--up %c says otherwise",
      is_y ? 'y' : 'z', 100 * std::max(0.0, is_y ? y : z), 100 * std::max(0.0, is_y ? z : y),
      is_y ? 'z' : 'y', is_y ? 'z' : 'y');
  cad.warnings.emplace_back(text);
  if (is_y) turnUp(cad, Vec3::UnitY());
}

std::optional<Vec3> axisFromText(const std::string& text) {
  const bool is_negative = text.starts_with("-");
  const std::string name = text.substr(is_negative ? 1 : 0);
  if (name.size() != 1 || name < "x" || name > "z") return std::nullopt;
  return Vec3((is_negative ? -1 : 1) * Vec3::Unit(name[0] - 'x'));
}

}  // namespace vps::scenes::inline v0
