// SPDX-License-Identifier: BSD-3-Clause
// Names in the file of a recording, for its writer and its reader.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "vps_device/device.h"

namespace vps::device::recording {

inline constexpr const char* kLibrary = "bullet-vps";  ///< marks a file as a recording of this program
inline constexpr const char* kProfile = "ros2";
inline constexpr const char* kAbout = "vps.run";
inline constexpr const char* kDevice = "vps.device";
inline constexpr const char* kEnd = "vps.end";
inline constexpr const char* kFormat = "1";  ///< increases when an older reader would misread the file
/// Topic of sync events in older recordings.
inline constexpr std::string_view kOldSyncTopic = "/run/meeting";

/// visit(name, number) for each number of the limits. The structured binding names every member, so that a
/// new member that is missing here does not compile.
template <typename Limits, typename Visit>
void eachLimit(Limits& limits, Visit&& visit) {
  auto& [force, peak_force, torque, peak_torque, min_D, max_D, rate, delay, damping, turn_damping, coulomb,
         turn_coulomb, resolution, turn_resolution, workspace_rad] = limits;
  visit("continuous_force_N", force);
  visit("peak_force_N", peak_force);
  visit("continuous_torque_Nm", torque);
  visit("peak_torque_Nm", peak_torque);
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    visit("workspace_min_m." + axis, min_D[i]);
    visit("workspace_max_m." + axis, max_D[i]);
  }
  visit("rate_hz", rate);
  visit("delay_s", delay);
  visit("damping_Ns_per_m", damping);
  visit("damping_Nms_per_rad", turn_damping);
  visit("coulomb_N", coulomb);
  visit("coulomb_Nm", turn_coulomb);
  visit("resolution_m", resolution);
  visit("resolution_rad", turn_resolution);
  visit("workspace_rad", workspace_rad);
}

}  // namespace vps::device::recording
