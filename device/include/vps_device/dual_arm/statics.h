// SPDX-License-Identifier: BSD-3-Clause
// Statics of the dual arm at one pose: the handle's weight, the stiffness of the structure, and the greatest
// force in a direction.
#pragma once

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

// --- Weight of the handle, which the plant has and the controller compensates; each arm is balanced

inline constexpr double kGravity_m_s2 = 9.81;

/// Wrench of the weight on the handle about its centre of mass, in D.
inline Wrench handleWeight(const DualArmParameters& parameters) noexcept {
  return {Vec3::Zero(), Vec3(0, 0, -parameters.handle_kg * kGravity_m_s2)};
}

// --- Elasticity between the motors and the handle, reduced to the joints

/// Stiffness of each joint [N m/rad, N/m, N m/rad] with the arms at `joints`: capstan, tendon and link in
/// series with the gimbal and the handle. The stiffness of gimbal and handle is equal in every direction;
/// since the columns of an arm's Jacobian are orthogonal, this stiffness acts on each joint separately.
VPS_DEVICE_API JointVector structureStiffness(const DualArmParameters& parameters,
                                              const JointVector& joints) noexcept;

/// Force on the joints by the change of structureStiffness() with the joints, with the springs extended by
/// `stretch`: -1/2 sum_i dK_i/dq stretch_i^2. Without this force a loaded moving arm would not conserve
/// energy.
VPS_DEVICE_API JointVector structureDrift(const DualArmParameters& parameters, const JointVector& joints,
                                          const JointVector& stretch) noexcept;

// --- Strength

/// Greatest upward force [N] with the handle straight and its midpoint at p_DE, motors at `limits`.
struct VerticalForce {
  double left_N = 0;   ///< force of the left arm alone, at its gimbal
  double right_N = 0;  ///< force of the right arm alone
  /// Force of both arms on the handle, without a couple, in addition to the handle's weight.
  double both_N = 0;
  double sum_N = 0;  ///< left_N + right_N less the weight; the hand has to bear the couple
};
/// Computes the greatest upward force; zero if the device is singular at this pose.
VPS_DEVICE_API VerticalForce verticalForce(const DualArmParameters& parameters, const Vec3& p_DE,
                                           const JointVector& limits) noexcept;

/// Motor efforts for forces along D's axes, or for torques about them: columns x, y, z.
struct EffortMap {
  Eigen::Matrix<double, 7, 3> force = Eigen::Matrix<double, 7, 3>::Zero();   ///< N m or N, per N at H
  Eigen::Matrix<double, 7, 3> torque = Eigen::Matrix<double, 7, 3>::Zero();  ///< N m or N, per N m about H
  JointVector weight = JointVector::Zero();  ///< efforts that carry the handle
};
[[nodiscard]] VPS_DEVICE_API Status effortMap(const DualArmParameters& parameters, const Pose& X_DH,
                                              EffortMap& map) noexcept;

/// Greatest force (or torque) that is available in every direction in addition to `weight`, exactly: the
/// motor with row a of `efforts` needs |a| per newton in its worst direction. `efforts` is EffortMap::force
/// or torque.
VPS_DEVICE_API double leastOverDirections(const Eigen::Matrix<double, 7, 3>& efforts,
                                          const JointVector& weight, const JointVector& limits) noexcept;

/// Greatest force or torque along one direction in addition to `weight`.
VPS_DEVICE_API double alongDirection(const Eigen::Matrix<double, 7, 3>& efforts, const JointVector& weight,
                                     const JointVector& limits, const Vec3& direction) noexcept;

}  // namespace vps::device
