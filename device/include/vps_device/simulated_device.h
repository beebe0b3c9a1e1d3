// SPDX-License-Identifier: BSD-3-Clause
// A device whose mechanics are simulated, and the hand model that moves it instead of a person.
#pragma once

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// Force of a hand on a handle, as an impedance about an equilibrium, so that a plant can integrate it
/// implicitly. Wrench of the hand on the handle about the handle's origin, in one frame (W from an operator,
/// D for a device):
///   f   = k (p_eq - p) + b (v_eq - v) + F.f,     tau = the same formula with rotation vectors + F.tau,
/// and the hand's own inertia moves with the handle. k and b are symmetric and not negative. By default there
/// is no hand.
struct HandForce {
  Pose X_eq;  ///< equilibrium of the handle
  Twist V_eq;
  Mat3 k_N_per_m = Mat3::Zero();
  Mat3 b_Ns_per_m = Mat3::Zero();
  Mat3 k_Nm_per_rad = Mat3::Zero();
  Mat3 b_Nms_per_rad = Mat3::Zero();
  Wrench F;            ///< feed-forward wrench
  double mass_kg = 0;  ///< effective mass of hand and forearm at the handle; the person carries its weight
  double inertia_kgm2 = 0;
};

/// The wrench of `hand` on a handle at X with velocity V, all in the hand's frame.
inline Wrench handWrench(const HandForce& hand, const Pose& X, const Twist& V) noexcept {
  Wrench F = hand.F;
  F.f += hand.k_N_per_m * (hand.X_eq.p - X.p) + hand.b_Ns_per_m * (hand.V_eq.v - V.v);
  F.tau += hand.k_Nm_per_rad * rotationVector(hand.X_eq.R * X.R.transpose()) +
           hand.b_Nms_per_rad * (hand.V_eq.w - V.w);
  return F;
}

class VPS_DEVICE_API SimulatedDevice : public Device {
 public:
  /// Advances the mechanics by dt_s with the hand `hand` (in D) on the handle. Never throws or allocates.
  virtual void step(double dt_s, const HandForce& hand) noexcept = 0;

  /// True state of the handle, for tests and for the operator's own senses; the loop uses read() only.
  [[nodiscard]] virtual const Pose& truePose() const noexcept = 0;
  [[nodiscard]] virtual const Twist& trueTwist() const noexcept = 0;
};

}  // namespace vps::device
