// SPDX-License-Identifier: BSD-3-Clause
// What the recorder and the reader of recordings both know of the file.
#pragma once

#include <map>
#include <string>

#include "vps_device/device.h"

namespace vps::recording {

inline constexpr const char* kLibrary = "bullet-vps";  ///< marks a file as ours
inline constexpr const char* kProfile = "ros2";
inline constexpr const char* kAbout = "vps.run";
inline constexpr const char* kDevice = "vps.device";
inline constexpr const char* kEnd = "vps.end";
inline constexpr const char* kFormat = "1";  ///< goes up when a reader of before would misread

/// visit(name, number) for each number of the limits.
template <typename Limits, typename Visit>
void eachLimit(Limits& l, Visit&& visit) {
  visit("continuous_force_N", l.continuous_force_N);
  visit("peak_force_N", l.peak_force_N);
  visit("continuous_torque_Nm", l.continuous_torque_Nm);
  visit("peak_torque_Nm", l.peak_torque_Nm);
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    visit("workspace_min_m." + axis, l.workspace_min_D[i]);
    visit("workspace_max_m." + axis, l.workspace_max_D[i]);
  }
  visit("rate_hz", l.rate_hz);
  visit("damping_Ns_per_m", l.damping_Ns_per_m);
  visit("damping_Nms_per_rad", l.damping_Nms_per_rad);
  visit("coulomb_N", l.coulomb_N);
  visit("coulomb_Nm", l.coulomb_Nm);
  visit("resolution_m", l.resolution_m);
  visit("resolution_rad", l.resolution_rad);
}

}  // namespace vps::recording
