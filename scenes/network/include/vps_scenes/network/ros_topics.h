// SPDX-License-Identifier: BSD-3-Clause
// Publishes a run as ROS 2 topics, so that ROS 2 tools (rviz2, ros2 topic, rosbag2) read it without a bridge.
#pragma once

#include <cstdint>
#include <memory>
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
VPS_SCENES_API std::string rosName(const std::string& name);

}  // namespace vps::scenes
