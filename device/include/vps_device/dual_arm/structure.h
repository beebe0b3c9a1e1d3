// SPDX-License-Identifier: BSD-3-Clause
// Elasticity between the dual arm's motors and its handle, reduced to the joints.
#pragma once

#include "vps_device/dual_arm/kinematics.h"
#include "vps_device/export.h"

namespace vps::device {

/// Stiffness of each joint [N m/rad, N/m, N m/rad] with the arms at `joints`: capstan, tendon and link in
/// series with the gimbal's and the handle's stiffness, which is the same in every direction and therefore,
/// since the columns of an arm's Jacobian are orthogonal, adds to each joint alone.
VPS_DEVICE_API JointVector structureStiffness(const DualArmParameters& parameters,
                                              const JointVector& joints) noexcept;

/// Force on the joints by the change of that stiffness with the joints, with the springs extended by
/// `stretch`: -1/2 sum_i dK_i/dq stretch_i^2. Without it a loaded moving arm would not conserve energy.
VPS_DEVICE_API JointVector structureDrift(const DualArmParameters& parameters, const JointVector& joints,
                                          const JointVector& stretch) noexcept;

}  // namespace vps::device
