// SPDX-License-Identifier: BSD-3-Clause
// The handle's weight, which the plant has and the controller compensates; each arm is balanced.
#pragma once

#include "vps/wrench.h"
#include "vps_device/dual_arm/parameters.h"

namespace vps::device {

inline constexpr double kGravity_m_s2 = 9.81;

/// On the handle about its centre of mass, in D.
inline Wrench handleWeight(const DualArmParameters& parameters) noexcept {
  return {Vec3::Zero(), Vec3(0, 0, -parameters.handle_kg * kGravity_m_s2)};
}

}  // namespace vps::device
