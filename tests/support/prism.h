// SPDX-License-Identifier: BSD-3-Clause
// Prisms: sections of straight edges, extruded. All their edges are sharp.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "vps/mesh.h"

namespace vps::test {

/// A section's corners (y, z), counter-clockwise seen from +x.
using Section = std::vector<Eigen::Vector2d>;

/// The section from x = 0 to x = length, closed and facing out. The section must not cross itself.
inline Mesh makePrism(const Section& section, double length_m) {
  const auto n = static_cast<std::uint32_t>(section.size());
  Mesh mesh;
  for (const double x : {0.0, length_m})
    for (const auto& p : section) mesh.vertices.emplace_back(x, p[0], p[1]);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  // End faces by cutting ears: a corner that turns left, with no other corner in its triangle.
  const auto cross = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Eigen::Vector2d u = section[b] - section[a], v = section[c] - section[a];
    return u[0] * v[1] - u[1] * v[0];
  };
  std::vector<std::uint32_t> left(n);
  std::iota(left.begin(), left.end(), 0U);
  while (left.size() >= 3) {
    const std::size_t before = left.size();
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                          c = left[(i + 1) % left.size()];
      if (!(cross(a, b, c) > 0)) continue;
      bool is_ear = true;
      for (const std::uint32_t p : left)
        if (p != a && p != b && p != c && cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0)
          is_ear = false;
      if (!is_ear) continue;
      mesh.triangles.push_back({n + a, n + b, n + c});
      mesh.triangles.push_back({c, b, a});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (left.size() == before) break;  // not a simple section
  }
  return mesh;
}

/// A rail with a T-slot along x, open at both ends and at the top: the neck from z = -neck_deep to 0, the
/// head below.
inline Section tSlotSection(double head_w, double head_h, double neck_w, double neck_deep, double wall) {
  const double y1 = neck_w / 2, y2 = head_w / 2, y3 = y2 + wall, z1 = -neck_deep, z2 = z1 - head_h,
               z3 = z2 - wall;
  return {{-y3, z3}, {y3, z3},  {y3, 0},   {y1, 0},   {y1, z1}, {y2, z1},
          {y2, z2},  {-y2, z2}, {-y2, z1}, {-y1, z1}, {-y1, 0}, {-y3, 0}};
}

/// The block that slides in it, each face `gap` inside; its neck ends `above` the rail.
inline Section tBlockSection(double head_w, double head_h, double neck_w, double neck_deep, double gap,
                             double above) {
  const double y1 = neck_w / 2 - gap, y2 = head_w / 2 - gap, z1 = -neck_deep - gap,
               z2 = -neck_deep - head_h + gap;
  return {{-y2, z2}, {y2, z2}, {y2, z1}, {y1, z1}, {y1, above}, {-y1, above}, {-y1, z1}, {-y2, z1}};
}

}  // namespace vps::test
