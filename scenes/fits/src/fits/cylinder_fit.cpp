// SPDX-License-Identifier: BSD-3-Clause
#include "fits/cylinder_fit.h"

#include <Eigen/Cholesky>

namespace vps::scenes {

bool fitCylinder(std::span<const Vec3> points, Cylinder& cylinder) {
  using Vec5 = Eigen::Matrix<double, 5, 1>;
  using Mat5 = Eigen::Matrix<double, 5, 5>;
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
    const double scale_m = cylinder.radius_m;  // makes tilts lengths
    Mat5 sum = Mat5::Zero();
    Vec5 right = Vec5::Zero();
    for (const Vec3& x : points) {
      const Vec3 out = cylinder.outward(x), r = out.normalized();
      const double along = cylinder.axis.dot(x - cylinder.p) / scale_m;
      Vec5 row;
      row << -r.dot(u), -r.dot(v), -along * r.dot(u), -along * r.dot(v), -1;
      sum += row * row.transpose();
      right -= row * (out.norm() - cylinder.radius_m);
    }
    const Vec5 step = sum.ldlt().solve(right);
    if (!step.allFinite() || step.norm() > cylinder.radius_m) return false;
    cylinder.p += step[0] * u + step[1] * v;
    cylinder.axis = (cylinder.axis + (step[2] * u + step[3] * v) / scale_m).normalized();
    cylinder.radius_m += step[4];
    if (step.norm() < 1e-13 * cylinder.radius_m) break;
  }
  return cylinder.radius_m > 0;
}

}  // namespace vps::scenes
