// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/vertex_normals.h"

#include "mesh/directions.h"

namespace vps {

std::vector<Vec3> angleWeightedNormals(const Mesh& mesh, std::span<const Vec3> facet_normals) {
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
