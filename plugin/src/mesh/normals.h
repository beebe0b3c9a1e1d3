// SPDX-License-Identifier: BSD-3-Clause
// Unit vectors, angles between directions, and normals of triangles and vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps {

/// v / |v|; zero if v is too short to have a direction.
inline Vec3 unitOrZero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// The angle between u and v. atan2 keeps its accuracy near 0 and pi, where acos loses half the digits.
inline double angleBetween(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// False for a triangle so slim that the direction of its normal is rounding error: twice its area is at most
/// 1e-10 of its longest edge's square.
inline bool hasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kMinSlimness = 1e-10;
  const double longest2 = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
  return (b - a).cross(c - a).norm() > kMinSlimness * longest2;
}

/// For each vertex the sum of the normals of its facets, each times the facet's angle there: a normal that
/// does not depend on how faces are cut into facets. Not of unit length; zero at the edge of a blade, where
/// the facets' normals cancel. Source: Thuermer and Wuethrich 1998. O(triangles).
/// @param facet_normals  unit, or zero for a facet without a normal
inline std::vector<Vec3> angleWeightedNormals(const Mesh& mesh, std::span<const Vec3> facet_normals) {
  std::vector<Vec3> sums(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3 corner[3] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    for (int k = 0; k < 3; ++k) {
      const double angle_rad = angleBetween(corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
      sums[t[k]] += angle_rad * facet_normals[i];
    }
  }
  return sums;
}

}  // namespace vps
