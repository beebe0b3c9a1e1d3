// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/head_topic.h"

#include "dds/ros_types.h"
#include "dds/topics.h"
#include "vps_scenes/scene/number_table.h"

namespace vps::scenes {
struct HeadTopic::Work {
  Work(const std::string& topic, int domain, const std::string& interface)
      : participant(SessionNetwork(interface, "none"), domain) {
    const dds_topic_descriptor_t type =
        ros::descriptor(ros::kPoseName, sizeof(ros::PoseStamped), ros::kPoseOps, ros::kPoseInstructions);
    const dds_entity_t name =
        ros::require(dds_create_topic(participant.entity(), &type, ("rt" + topic).c_str(), nullptr, nullptr));
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);  // matches reliable writers, too
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    reader = dds_create_reader(participant.entity(), name, qos, nullptr);
    dds_delete_qos(qos);
    ros::require(reader);
  }

  DdsParticipant participant;  // deleting it deletes its reader
  dds_entity_t reader = 0;
};

HeadTopic::HeadTopic(const std::string& topic, int domain, const std::string& interface)
    : work_(std::make_unique<Work>(topic, domain, interface)) {}
HeadTopic::~HeadTopic() = default;

std::optional<Pose> HeadTopic::take() {
  std::optional<Pose> newest;
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info{};
    const dds_return_t count = dds_take(work_->reader, &sample, &info, 1, 1);
    if (count <= 0) return newest;
    if (info.valid_data)
      if (const std::optional<Pose> X = poseOf(static_cast<const ros::PoseStamped*>(sample)->pose))
        newest = X;
    dds_return_loan(work_->reader, &sample, count);
  }
}

}  // namespace vps::scenes
