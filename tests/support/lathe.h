// SPDX-License-Identifier: BSD-3-Clause
// Turned parts for tests: a profile swept around z.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "vps/mesh.h"

namespace vps::test {

/// Sweeps a closed profile of (r, z) points [m] around z. The profile runs counter-clockwise in the (r, z)
/// plane around the solid and closes by itself; edges on the axis make no surface. Vertices lie on the true
/// circles, so flats are inside them by r (1 - cos(pi / segments)). The mesh is closed, faces outwards, and
/// shares its vertices.
inline Mesh lathe(const std::vector<std::array<double, 2>>& profile, int segments) {
  Mesh mesh;
  std::vector<std::uint32_t> first;  // vertex index of each profile point; one vertex if on the axis
  for (const auto& [r, z] : profile) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const int copies = r == 0 ? 1 : segments;
    for (int s = 0; s < copies; ++s) {
      const double angle_rad = 2 * std::numbers::pi * s / segments;
      mesh.vertices.emplace_back(r * std::cos(angle_rad), r * std::sin(angle_rad), z);
    }
  }
  const auto vertex = [&](std::size_t point, int s) {
    return profile[point][0] == 0 ? first[point] : first[point] + static_cast<std::uint32_t>(s % segments);
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const std::size_t j = (i + 1) % profile.size();
    if (profile[i][0] == 0 && profile[j][0] == 0) continue;
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t a = vertex(i, s), b = vertex(i, s + 1), c = vertex(j, s + 1), d = vertex(j, s);
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace vps::test
