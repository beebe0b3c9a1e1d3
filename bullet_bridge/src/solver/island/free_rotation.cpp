// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island/island.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "vps/contact_tolerances.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {
namespace {

// The factor h(W) in the equation of meanAngularVelocity() (island.h). Above kBulletTurn_rad Bullet limits
// the angle in sine and cosine but not the length of the axis, so that the tangent of half the rotation
// continues to grow in proportion to the speed.
double halfTangent_s(double speed_rad_s, double dt_s) {
  const double angle_rad = std::min(speed_rad_s * dt_s, kBulletTurn_rad);
  return angle_rad > 0 ? dt_s * std::tan(0.5 * angle_rad) / angle_rad : 0.5 * dt_s;
}

/// The equation of meanAngularVelocity() for one body.
struct MeanVelocity {
  Vec3 inertia_kg_m2, L;

  [[nodiscard]] Vec3 rest(const Vec3& W, double dt_s) const {
    const Vec3 JW = inertia_kg_m2.cwiseProduct(W);
    return JW - L + halfTangent_s(W.norm(), dt_s) * W.cross(JW);
  }
  /// Newton's method, starting at W. The derivative neglects that the factor h (halfTangent_s) depends on W,
  /// an effect of second order in dt_s.
  [[nodiscard]] Vec3 solve(Vec3 W, double dt_s) const {
    double last_change_rad_s = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMostIterations; ++i) {
      const Vec3 rest_Nms = rest(W, dt_s);
      if (rest_Nms.isZero(0)) break;
      const Mat3 J = inertia_kg_m2.asDiagonal();
      const Mat3 slope = J + halfTangent_s(W.norm(), dt_s) *
                                 (crossMatrix(W) * J - crossMatrix(inertia_kg_m2.cwiseProduct(W)));
      const Vec3 change = slope.inverse() * rest_Nms;
      const double change_rad_s = change.norm();
      if (change_rad_s <= kRoundingShare * W.norm() && !(change_rad_s < last_change_rad_s)) break;
      last_change_rad_s = change_rad_s;
      W -= change;
    }
    return W;
  }
};

}  // namespace

Vec3 meanAngularVelocity(const Vec3& inertia_kg_m2, const Vec3& w_B, double dt_s) {
  const MeanVelocity mean{inertia_kg_m2, inertia_kg_m2.cwiseProduct(w_B)};
  // A long turn starts from the solution of half of it, since Newton's method may not converge from W = w.
  const double turn_rad = w_B.norm() * dt_s;
  Vec3 W = w_B;
  if (std::isfinite(turn_rad))
    for (double share = kBulletTurn_rad / turn_rad; share < 1; share *= 2) W = mean.solve(W, share * dt_s);
  W = mean.solve(W, dt_s);
  // returns w_B also if a value is not finite
  return mean.rest(W, dt_s).norm() <= kRoundingShare * mean.L.norm() ? W : w_B;
}

}  // namespace vps::bullet
