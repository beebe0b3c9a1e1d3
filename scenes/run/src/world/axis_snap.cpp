// SPDX-License-Identifier: BSD-3-Clause
#include "world/axis_snap.h"

#include <algorithm>
#include <cmath>

#include "scene/steps.h"

namespace vps::scenes {
namespace {

constexpr double kShare = 1.0 / 3;                // greatest snap force, as a share of the device's peaks
constexpr double kForce_N = 3, kTorque_Nm = 0.2;  // peaks without force output. assumed: a light guide
constexpr double kStiffest_N_per_m = 1000;        // assumed: 3 mm off the axis, a person feels 2 N
constexpr double kStiffest_Nm_per_rad = 2;        // assumed: at 0.05 rad, a person feels 0.1 N m
// Share of the greatest stable stiffness of an explicit spring, 4 m / dt^2 (Euler's symplectic method). The
// share is small, since the coupling adds its own stiffness.
constexpr double kStable = 0.1;

double square(double x) {
  return x * x;
}

}  // namespace

double ReachingSpring::force(double x) const {
  return x < reach ? k * x * square(1 - square(x / reach)) : 0;
}

double ReachingSpring::energy_J(double x) const {
  const double left = x < reach ? 1 - square(x / reach) : 0;
  return k * square(reach) / 6 * (1 - left * left * left);
}

Wrench AxisSnap::wrench(const Pose& X_WP) const {
  const Vec3 from_W = X_WP * p_PG - p_W;
  const Vec3 off_W = from_W - axis_W * axis_W.dot(from_W);
  const Vec3 now_W = X_WP.R * axis_P;
  const Vec3 lever_W = now_W.cross(axis_W);
  const double off_m = off_W.norm(), sine = lever_W.norm(), off_rad = std::atan2(sine, now_W.dot(axis_W));
  Wrench F;
  if (off_m > 0) F.f = -line.force(off_m) / off_m * off_W;
  if (sine > 0) F.tau = turn.force(off_rad) / sine * lever_W;
  return F;
}

double AxisSnap::energy_J(const Pose& X_WP) const {
  const Vec3 from_W = X_WP * p_PG - p_W;
  const Vec3 now_W = X_WP.R * axis_P;
  return line.energy_J((from_W - axis_W * axis_W.dot(from_W)).norm()) +
         turn.energy_J(std::atan2(now_W.cross(axis_W).norm(), now_W.dot(axis_W)));
}

std::optional<AxisSnap> axisSnap(const SceneStep& step, const Vec3& p_PG, const device::DeviceLimits& limits,
                                 double mass_kg, double least_I, double dt_s) {
  const Vec3 axis_W = insertionAxis(step, Pose::translation(p_PG));
  if (axis_W.isZero()) return {};
  const auto peak = [](double device, double otherwise) { return device > 0 ? kShare * device : otherwise; };
  const double stable = kStable * 4 / square(dt_s);
  return AxisSnap{step.X_WP_target * p_PG,
                  axis_W,
                  step.X_WP_target.R.transpose() * axis_W,
                  p_PG,
                  ReachingSpring::withPeak(std::min(kStiffest_N_per_m, stable * mass_kg),
                                           peak(limits.peak_force_N, kForce_N)),
                  ReachingSpring::withPeak(std::min(kStiffest_Nm_per_rad, stable * least_I),
                                           peak(limits.peak_torque_Nm, kTorque_Nm))};
}

}  // namespace vps::scenes
