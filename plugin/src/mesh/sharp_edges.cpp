// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh.h"

#include <cmath>

#include "mesh/mesh_edges.h"

namespace vps {

namespace {

Vec3 faceNormal(const Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> sharpEdges(const Mesh& mesh, double angle_rad) {
  std::vector<std::array<std::uint32_t, 2>> sharp;
  const double greatest_cos = std::cos(angle_rad);
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    const bool is_smooth =
        sides.size() == 2 &&
        faceNormal(mesh, sides[0].triangle).dot(faceNormal(mesh, sides[1].triangle)) >= greatest_cos;
    if (!is_smooth) sharp.push_back({sides[0].low, sides[0].high});
  });
  return sharp;
}

}  // namespace vps
