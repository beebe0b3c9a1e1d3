// SPDX-License-Identifier: BSD-3-Clause
// What bends between the dual arm's motors and its handle, seen at the joints.
#pragma once

#include "vps_device/dual_arm.h"
#include "vps_device/export.h"

namespace vps::device {

/// Stiffness of each joint [N m/rad, N/m, N m/rad] with the arms at `joints`: capstan, tendon and link in
/// series with the gimbal's and the handle's stiffness, which is the same in every direction and therefore,
/// since the columns of an arm's Jacobian are orthogonal, adds to each joint alone.
VPS_DEVICE_API JointVector structureStiffness(const DualArmParameters& parameters,
                                              const JointVector& joints) noexcept;

/// Force on the joints by the change of that stiffness with the joints, where the springs are stretched by
/// `stretch`: -1/2 sum_i dK_i/dq stretch_i^2. Without it a loaded arm that moves would not keep its energy.
VPS_DEVICE_API JointVector structureDrift(const DualArmParameters& parameters, const JointVector& joints,
                                          const JointVector& stretch) noexcept;

}  // namespace vps::device
