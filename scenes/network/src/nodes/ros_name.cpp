// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>

#include "vps_scenes/network/ros_topics.h"

namespace vps::scenes {

std::string rosName(const std::string& name) {
  // ROS 2 names must not begin with a digit.
  const bool needs_start = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0;
  std::string allowed(needs_start ? 1 : 0, '_');
  for (const char c : name) allowed.push_back(std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_');
  return allowed;
}

}  // namespace vps::scenes
