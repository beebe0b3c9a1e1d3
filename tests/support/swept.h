// SPDX-License-Identifier: BSD-3-Clause
// Closed meshes from sections around the z axis: the basis of gears, threads, pegs and bores.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "vps/mesh.h"

namespace vps::test {

inline constexpr double kTurn_rad = 2 * std::numbers::pi;

/// A point at radius r and angle a in the xy plane.
inline Vec3 polar(double r_m, double angle_rad, double z_m) {
  return {r_m * std::cos(angle_rad), r_m * std::sin(angle_rad), z_m};
}

/// Joins sections 0 to `columns` into a closed surface. `section(i)` is a closed loop of points [m],
/// counter-clockwise in the (r, z) plane around the solid, with the same number of points for every i.
/// section(columns) ends where section(0) begins, perhaps some rows further along (a thread). Points that
/// coincide to the bit become one vertex, and triangles that collapse are removed, which happens on the axis
/// and where a thread ends at an end face.
template <typename Section>
Mesh sweptSections(int columns, Section section) {
  Mesh mesh;
  std::uint32_t rows = 0;
  for (int i = 0; i <= columns; ++i) {
    const std::vector<Vec3> loop = section(i);
    rows = static_cast<std::uint32_t>(loop.size());
    mesh.vertices.insert(mesh.vertices.end(), loop.begin(), loop.end());
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i)
    for (std::uint32_t k = 0; k < rows; ++k) {
      const std::uint32_t next = (k + 1) % rows;
      const std::uint32_t a = i * rows + k, b = a + rows, d = i * rows + next, c = d + rows;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return welded(mesh);
}

/// Appends points from a (included) to b (excluded) in `steps` equal steps.
inline void appendLine(std::vector<Vec3>& loop, const Vec3& a, const Vec3& b, int steps) {
  for (int k = 0; k < steps; ++k) loop.push_back(a + (b - a) * (static_cast<double>(k) / steps));
}

/// Radius, at an angle, of a regular polygon that has corners at multiples of a turn / sides.
inline double polygonRadius(double corner_m, int sides, double angle_rad) {
  const double half_rad = std::numbers::pi / sides;
  const double from_middle_rad = std::remainder(angle_rad - half_rad, 2 * half_rad);
  return corner_m * std::cos(half_rad) / std::cos(from_middle_rad);
}

}  // namespace vps::test
