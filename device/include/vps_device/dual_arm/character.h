// SPDX-License-Identifier: BSD-3-Clause
// The device's own Table 1, computed from its model over the whole workspace.
#pragma once

#include <vector>

#include "vps/coupling_law.h"
#include "vps/errors.h"
#include "vps_device/device.h"
#include "vps_device/dual_arm/statics.h"
#include "vps_device/export.h"

namespace vps::device {

/// A figure over all sampled places and attitudes.
struct Extent {
  double least = 0, median = 0, greatest = 0;
};

/// A figure with the motors at their continuous limits and at their peak.
struct Duty {
  Extent continuous, peak;
};

struct DualArmCharacter {
  // Workspace.
  Vec3 workspace_m = Vec3::Zero();  ///< workspace of the parameters
  /// Greatest box of the workspace's shape that is reached with the handle straight, as a multiple of
  /// workspace_m.
  double straight_scale = 0;
  double tilted_scale = 0;           ///< straight_scale with every tilt of up to 45 deg
  double gimbal_sr = 0;              ///< handle directions within the gimbal's range
  Extent solid_angle_sr;             ///< directions that joints and arms allow, over the workspace
  double centre_solid_angle_sr = 0;  ///< solid_angle_sr at the workspace's centre
  // Motors. In the "worst direction": available in every direction at a place and attitude. Attitudes:
  // straight, and 45 deg tilts.
  Duty straight_force_N, force_N;      ///< worst direction; handle straight, and all attitudes
  Duty straight_torque_Nm, torque_Nm;  ///< worst direction; handle straight, and all attitudes
  Duty any_force_N, any_torque_Nm;     ///< statistics also over directions; the median is the typical value
  Duty up_N, left_up_N, right_up_N, sum_up_N;  ///< as in the paper's figure 5, straight
  // Mechanics.
  Extent held_stiffness_N_per_m;  ///< the hand holds the handle's direction
  Extent free_stiffness_N_per_m;  ///< the handle may rotate
  Extent mass_kg, inertia_kgm2;   ///< reflected at the handle, in each direction
  // Errors of readings, and friction.
  Extent resolution_m,
      resolution_rad;  ///< error of a reading with each encoder half a step off; tilts to 45 deg
  Extent far_resolution_m,
      far_resolution_rad;  ///< error of a reading in all directions within the gimbal's range
  /// Dry friction against a shift of the straight handle, in each direction. A weaker force is not felt.
  Extent friction_N;
  double force_ratio = 0, peak_force_ratio = 0;  ///< ratio of the greatest force to the typical friction
  // Isotropy.
  /// Greatest motor load for a force: its least value over all places, divided by its greatest value.
  double pair_isotropy = 0, arm_isotropy = 0;
  Extent ellipsoid_isotropy;      ///< for both arms: weakest over strongest direction at a place
  Extent arm_ellipsoid_isotropy;  ///< for one arm: weakest over strongest direction at a place
  Extent arm_manipulability_m2;   ///< Yoshikawa's, sqrt(det J J^T) = d^2 cos t2 of one arm
  Extent pair_force_mean_N;       ///< geometric mean of the force ellipsoid's half axes, continuous
  // Clearance between the arms' sliding links.
  double straight_clearance_m = 0, tilted_clearance_m = 0;  ///< least, with the handle tilted up to 45 deg
  /// Least, with the handle in all directions that the joints allow; negative: the arms collide.
  double far_clearance_m = 0;
  // Coupling.
  DeviceLimits limits_1kHz, limits_4kHz;
  CouplingGains gains_1kHz, gains_4kHz;  ///< with physics at 1 kHz
};

/// Takes about a second. `progress` may be empty.
VPS_DEVICE_API DualArmCharacter characterise(const DualArmParameters& parameters,
                                             const Progress& progress = {});

/// The paper's figure 5: the vertical force at each place of a grid over the workspace.
struct VerticalForceAt {
  Vec3 p_DE;
  VerticalForce force;
};
VPS_DEVICE_API std::vector<VerticalForceAt> verticalForces(const DualArmParameters& parameters,
                                                           double peak_share = 0);

}  // namespace vps::device
