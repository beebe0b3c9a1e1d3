// SPDX-License-Identifier: BSD-3-Clause
// Where a tracked head is now, from the network.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// A pose topic of ROS 2 (geometry_msgs/PoseStamped), as trackers publish it. Its frame is not looked at: the
/// poses are in the room. Used by one thread; nothing waits.
class VPS_SCENES_API HeadTopic {
 public:
  /// @param topic      "/anna/head"
  /// @param domain     ROS_DOMAIN_ID, 0 to 232
  /// @param interface  of the network; "lo": this machine only
  /// Throws LoadError where this build has no network, or the system refuses.
  HeadTopic(const std::string& topic, int domain, const std::string& interface);
  ~HeadTopic();
  HeadTopic(const HeadTopic&) = delete;
  HeadTopic& operator=(const HeadTopic&) = delete;

  /// The newest pose since the last call. What is no pose (not finite, no rotation) is left out.
  std::optional<Pose> take();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes
