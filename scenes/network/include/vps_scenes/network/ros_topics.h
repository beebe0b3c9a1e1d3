// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 topics without a bridge: publishes a run, which ROS 2 tools (rviz2, ros2 topic, rosbag2) read, and
// receives poses of tracked heads.
#pragma once

#include <cctype>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_scenes/export.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Publishes these topics, with ROS 2's default quality of service (reliable, volatile):
///
///     /vps/SESSION/handle   geometry_msgs/PoseStamped     the handle
///     /vps/SESSION/force    geometry_msgs/WrenchStamped   force and torque on the hand
///     /tf                   tf2_msgs/TFMessage            each part present, as SESSION/PART
///
/// All poses are in the frame "world", stamped with the system time. Used by one thread; publish() may block,
/// so it is called by watchers only.
class VPS_SCENES_API RosTopics {
 public:
  /// @param domain     ROS_DOMAIN_ID, 0 to 232
  /// @param interface  network interface; "lo": this machine only. On other interfaces everybody who can
  /// reach them can read the topics, since ROS 2's tools do not use the session's certificates Throws
  /// LoadError if this build has no network support, or the system refuses.
  RosTopics(int domain, const std::string& interface, const std::string& session, const Scene& scene);
  ~RosTopics();
  RosTopics(const RosTopics&) = delete;
  RosTopics& operator=(const RosTopics&) = delete;

  /// @param time_ns  system time since 1970
  void publish(const Snapshot& shot, std::int64_t time_ns);
  void publish(const Wrench& F_hand_W, std::int64_t time_ns);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// Replaces characters that ROS 2 does not allow in names (all but letters, digits and _) by _.
inline std::string rosName(const std::string& name) {
  // ROS 2 names must not begin with a digit.
  const bool needs_start = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0;
  std::string allowed(needs_start ? 1 : 0, '_');
  for (const char c : name) allowed.push_back(std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_');
  return allowed;
}

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
