// SPDX-License-Identifier: BSD-3-Clause
#include "solver/free_rotation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vps::bullet::inline v0 {
namespace {

// h of the header, for a speed of rotation.
double halfTangent_s(double speed_rad_s, double dt_s) {
  constexpr double kMostTurn_rad = std::numbers::pi / 4;  // ANGULAR_MOTION_THRESHOLD of btTransformUtil.h
  const double angle_rad = std::min(speed_rad_s * dt_s, kMostTurn_rad);
  return speed_rad_s > 0 ? std::tan(0.5 * angle_rad) / speed_rad_s : 0.5 * dt_s;
}

}  // namespace

Vec3 meanAngularVelocity(const Vec3& inertia_kg_m2, const Vec3& w_B, double dt_s) {
  constexpr int kMostIterations = 30;
  constexpr double kConverged = 1e-9;  // share of the momentum
  const auto momentumOf = [&](const Vec3& w) { return Vec3(inertia_kg_m2.cwiseProduct(w)); };
  const Vec3 L = momentumOf(w_B);
  Vec3 W = w_B;
  double last_change_rad_s = std::numeric_limits<double>::infinity();
  const auto restOf = [&](const Vec3& of) {
    const Vec3 J_of = momentumOf(of);
    return Vec3(J_of - L + halfTangent_s(of.norm(), dt_s) * of.cross(J_of));
  };
  for (int i = 0; i < kMostIterations; ++i) {
    const double h = halfTangent_s(W.norm(), dt_s);
    const Vec3 JW = momentumOf(W);
    const Vec3 rest = restOf(W);
    if (rest.isZero(0)) break;
    // The dependence of h on W is of second order in the step, and is left out of the slope.
    const Mat3 slope = Mat3(inertia_kg_m2.asDiagonal()) +
                       h * (crossMatrix(W) * Mat3(inertia_kg_m2.asDiagonal()) - crossMatrix(JW));
    const Vec3 change = slope.inverse() * rest;
    // Below the rounding changes no longer fall.
    constexpr double kClose = 1e-9;
    const double change_rad_s = change.norm();
    if (change_rad_s <= kClose * W.norm() && !(change_rad_s < last_change_rad_s)) break;
    last_change_rad_s = change_rad_s;
    W -= change;
  }
  return restOf(W).norm() <= kConverged * L.norm() ? W : w_B;  // w_B also where a value is not finite
}

}  // namespace vps::bullet::inline v0
