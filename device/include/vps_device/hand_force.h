// SPDX-License-Identifier: BSD-3-Clause
// The force of a hand on a handle, as an impedance about an equilibrium, so that a plant can integrate it
// implicitly.
#pragma once

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/export.h"

namespace vps::device {

/// Wrench of the hand on the handle about the handle's origin, in frame A: W from an operator, D for a
/// device.
///   f   = k (p_eq - p) + b (v_eq - v) + F.f,     tau = the same with rotation vectors + F.tau,
/// and the hand's own inertia moves with the handle. k and b symmetric, not negative. Default: no hand.
struct HandForce {
  Pose X_eq;  ///< equilibrium of the handle
  Twist V_eq;
  Mat3 k_N_per_m = Mat3::Zero();
  Mat3 b_Ns_per_m = Mat3::Zero();
  Mat3 k_Nm_per_rad = Mat3::Zero();
  Mat3 b_Nms_per_rad = Mat3::Zero();
  Wrench F;            ///< feed-forward
  double mass_kg = 0;  ///< of hand and forearm, as felt at the handle; the person carries its weight
  double inertia_kgm2 = 0;
};

/// The wrench of `hand` on a handle at X with velocity V, all in the hand's frame.
VPS_DEVICE_API Wrench handWrench(const HandForce& hand, const Pose& X, const Twist& V) noexcept;

}  // namespace vps::device
