// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/hand_force.h"

namespace vps::device {

Wrench handWrench(const HandForce& hand, const Pose& X, const Twist& V) noexcept {
  Wrench F = hand.F;
  F.f += hand.k_N_per_m * (hand.X_eq.p - X.p) + hand.b_Ns_per_m * (hand.V_eq.v - V.v);
  F.tau += hand.k_Nm_per_rad * rotationVector(hand.X_eq.R * X.R.transpose()) +
           hand.b_Nms_per_rad * (hand.V_eq.w - V.w);
  return F;
}

}  // namespace vps::device
