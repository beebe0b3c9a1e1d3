// SPDX-License-Identifier: BSD-3-Clause
// Poses of a tracked head, received from the network.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// Receives a pose topic of ROS 2 (geometry_msgs/PoseStamped), as trackers publish it. The frame name is
/// ignored: poses are in the room's frame. Used by one thread; no call waits.
class VPS_SCENES_API HeadTopic {
 public:
  /// @param topic      name of the topic, such as "/anna/head"
  /// @param domain     ROS_DOMAIN_ID, 0 to 232
  /// @param interface  network interface; "lo": this machine only
  /// Throws LoadError if this build has no network support, or the system refuses.
  HeadTopic(const std::string& topic, int domain, const std::string& interface);
  ~HeadTopic();
  HeadTopic(const HeadTopic&) = delete;
  HeadTopic& operator=(const HeadTopic&) = delete;

  /// The newest pose since the last call. Invalid poses (not finite, or not a rotation) are ignored.
  std::optional<Pose> take();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes
