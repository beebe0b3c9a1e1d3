// SPDX-License-Identifier: BSD-3-Clause
// Axis snap, a virtual fixture (Rosenberg 1993): a spring that pulls the part in hand to the insertion axis
// of its step and turns it parallel to that axis. The part is free to move along the axis and to turn about
// the axis.
#pragma once

#include <optional>

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/device.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A spring whose force vanishes with distance: F(x) = k x (1 - (x/r)^2)^2 up to its reach r, and 0 beyond r,
/// so that force and stiffness are continuous. The greatest force is kPeak k r, at r / sqrt(5).
struct ReachingSpring {
  static constexpr double kPeak = 0.28621670111997307;  ///< 16 / (25 sqrt(5))

  double k = 0, reach = 0;

  /// The spring of stiffness k whose greatest force is `peak`.
  static ReachingSpring withPeak(double k, double peak) { return {k, peak / (kPeak * k)}; }
  [[nodiscard]] double force(double x) const;
  /// Integral of the force from 0 to x.
  [[nodiscard]] double energy_J(double x) const;
};

struct AxisSnap {
  Vec3 p_W = Vec3::Zero();  ///< a point on the axis: the origin of the grasp frame at the target
  Vec3 axis_W = Vec3::UnitZ();
  Vec3 axis_P = Vec3::UnitZ();  ///< the axis in the part's frame P, at the target
  Vec3 p_PG = Vec3::Zero();     ///< origin of the grasp frame, at which the spring acts
  ReachingSpring line, turn;    ///< springs of distance [N/m, m] and of angle [N m/rad, rad]

  /// Wrench on the part at its grasp frame, in W. The wrench is finite and bounded by the springs' peaks for
  /// any finite pose.
  [[nodiscard]] Wrench wrench(const Pose& X_WP) const;
  [[nodiscard]] double energy_J(const Pose& X_WP) const;
};

/// Axis snap of a step. Its peaks are a third of the device's peaks, so that the hand can leave the axis and
/// contacts are still felt. There is no snap if the last leg of the path has no length.
/// @param dt_s       physics step, which bounds the stiffness
/// @param least_I    least moment of inertia [kg m^2]
std::optional<AxisSnap> axisSnap(const SceneStep& step, const Vec3& p_PG, const device::DeviceLimits& limits,
                                 double mass_kg, double least_I, double dt_s);

}  // namespace vps::scenes
