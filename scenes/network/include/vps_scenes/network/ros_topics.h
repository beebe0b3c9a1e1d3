// SPDX-License-Identifier: BSD-3-Clause
// A run as topics of ROS 2, which its tools (rviz2, ros2 topic, rosbag2) read without a bridge.
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

/// Publishes, reliable and volatile as ROS 2's default:
///
///     /vps/SESSION/handle   geometry_msgs/PoseStamped     the handle
///     /vps/SESSION/force    geometry_msgs/WrenchStamped   force and torque on the hand
///     /tf                   tf2_msgs/TFMessage            each part that is there, as SESSION/PART
///
/// in the frame "world", stamped with the system's time. Used by one thread, which it may hold up; so it is
/// for watchers.
class VPS_SCENES_API RosTopics {
 public:
  /// @param domain     ROS_DOMAIN_ID, 0 to 232
  /// @param interface  of the network; "lo": this machine only. On others everybody who reaches them reads
  /// the
  ///                   topics: ROS 2's tools know nothing of the session's certificates
  /// Throws LoadError where this build has no network, or the system refuses.
  RosTopics(int domain, const std::string& interface, const std::string& session, const Scene& scene);
  ~RosTopics();
  RosTopics(const RosTopics&) = delete;
  RosTopics& operator=(const RosTopics&) = delete;

  /// @param time_ns  since 1970
  void publish(const Snapshot& shot, std::int64_t time_ns);
  void publish(const Wrench& F_hand_W, std::int64_t time_ns);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// A name as ROS 2 allows them: letters, digits and _; others become _.
VPS_SCENES_API std::string rosName(const std::string& name);

}  // namespace vps::scenes
