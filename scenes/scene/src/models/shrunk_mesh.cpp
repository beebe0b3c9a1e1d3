// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <Eigen/QR>

#include <cmath>
#include <vector>

namespace vps::scenes {

namespace {

constexpr double kSameFace = 1e-9;     // least 1 - cos of the angle of two facets that count separately
constexpr double kIndependent = 0.02;  // facets that differ by less than a degree count as one face
constexpr double kFarthest = 3;        // greatest move of a corner / move of its facets; a cube needs 1.7

/// The displacement of a corner that moves all its facets inwards, or outwards for a negative distance.
Vec3 inwards(const std::vector<Vec3>& normals, double by_m) {
  if (normals.empty()) return Vec3::Zero();
  Eigen::MatrixX3d planes(static_cast<Eigen::Index>(normals.size()), 3);
  for (std::size_t i = 0; i < normals.size(); ++i)
    planes.row(static_cast<Eigen::Index>(i)) = normals[i].transpose();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixX3d> solver;
  solver.setThreshold(kIndependent);
  solver.compute(planes);
  const Vec3 move = solver.solve(Eigen::VectorXd::Constant(planes.rows(), -by_m));
  const double length_m = move.norm(), most_m = kFarthest * std::abs(by_m);
  return length_m > most_m ? Vec3(move * (most_m / length_m)) : move;
}

}  // namespace

Mesh shrunkMesh(const Mesh& mesh, double by_m) {
  std::vector<std::vector<Vec3>> normals(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vec3 across = (q - p).cross(r - p);
    if (across.norm() == 0) continue;
    const Vec3 n = across.normalized();
    for (const std::uint32_t corner : {a, b, c}) {
      bool is_new = true;
      for (const Vec3& known : normals[corner]) is_new = is_new && 1 - known.dot(n) > kSameFace;
      if (is_new) normals[corner].push_back(n);
    }
  }
  Mesh out = mesh;
  for (std::size_t i = 0; i < out.vertices.size(); ++i) out.vertices[i] += inwards(normals[i], by_m);
  return out;
}

}  // namespace vps::scenes
