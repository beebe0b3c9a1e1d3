// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 topics over Cyclone DDS. Topic names follow ROS 2's mapping to DDS (design.ros2.org, "Topic and
// Service name mapping to DDS").
#include "vps_scenes/network/ros_topics.h"

#include <dds/dds.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "dds/topics.h"
#include "vps/errors.h"
#include "vps_scenes/scene/number_table.h"

namespace vps::scenes {

namespace {

// ROS 2 message types, described for Cyclone DDS. The layouts are those of ROS 2's common_interfaces. Nested
// structures are flattened, which does not change the bytes on the wire.
namespace ros {

struct Header {
  std::int32_t sec;
  std::uint32_t nanosec;
  char* frame;
};
struct PoseStamped {
  Header header;
  double pose[7];  ///< position, then orientation x y z w
};

constexpr std::uint32_t kNumber = static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_4BY;
constexpr std::uint32_t kText = static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_STR;
constexpr std::uint32_t kDoubles =
    static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_ARR | DDS_OP_SUBTYPE_8BY;
constexpr std::uint32_t kPoseOps[] = {kNumber,  offsetof(PoseStamped, header.sec),
                                      kNumber,  offsetof(PoseStamped, header.nanosec),
                                      kText,    offsetof(PoseStamped, header.frame),
                                      kDoubles, offsetof(PoseStamped, pose),
                                      7,        DDS_OP_RTS};
constexpr std::uint32_t kPoseInstructions = 5;
constexpr const char* kPoseName = "geometry_msgs::msg::dds_::PoseStamped_";

/// @param instructions  number of instructions in ops
dds_topic_descriptor_t descriptor(const char* name, std::size_t size, const std::uint32_t* ops,
                                  std::uint32_t instructions) {
  return {.m_size = static_cast<std::uint32_t>(size),
          .m_align = alignof(double),
          .m_flagset = 0,
          .m_nkeys = 0,
          .m_typename = name,
          .m_keys = nullptr,
          .m_nops = instructions,
          .m_ops = ops,
          .m_meta = "",
          .type_information = {},
          .type_mapping = {},
          .restrict_data_representation = 0};
}

/// Returns the entity. Throws LoadError if DDS refused to make the entity.
dds_entity_t require(dds_entity_t made) {
  if (made >= 0) return made;
  throw LoadError("", "", std::string("ROS 2 topics: ") + dds_strretcode(-made));
}

}  // namespace ros

using ros::descriptor, ros::Header, ros::kDoubles, ros::kNumber, ros::kText, ros::PoseStamped, ros::require;

constexpr const char* kWorld = "world";

struct WrenchStamped {
  Header header;
  double wrench[6];  ///< force, then torque
};
struct TransformStamped {
  Header header;
  char* child_frame;
  double transform[7];  ///< translation, then rotation x y z w
};
struct TfMessage {
  dds_sequence_t transforms;
};

constexpr std::uint32_t kList = static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_SEQ | DDS_OP_SUBTYPE_STU;

constexpr std::uint32_t kWrenchOps[] = {kNumber,  offsetof(WrenchStamped, header.sec),
                                        kNumber,  offsetof(WrenchStamped, header.nanosec),
                                        kText,    offsetof(WrenchStamped, header.frame),
                                        kDoubles, offsetof(WrenchStamped, wrench),
                                        6,        DDS_OP_RTS};
// Operands of a list: the list's offset, the size of an element, and the distances to the next instruction
// and to the instructions of an element.
constexpr std::uint32_t kTfOps[] = {kList,
                                    offsetof(TfMessage, transforms),
                                    sizeof(TransformStamped),
                                    (4U << 16U) + 5U,
                                    DDS_OP_RTS,
                                    kNumber,
                                    offsetof(TransformStamped, header.sec),
                                    kNumber,
                                    offsetof(TransformStamped, header.nanosec),
                                    kText,
                                    offsetof(TransformStamped, header.frame),
                                    kText,
                                    offsetof(TransformStamped, child_frame),
                                    kDoubles,
                                    offsetof(TransformStamped, transform),
                                    7,
                                    DDS_OP_RTS};

dds_entity_t makeWriter(const DdsParticipant& participant, const std::string& name,
                        const dds_topic_descriptor_t& type, int depth) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  const dds_entity_t topic = dds_create_topic(participant.entity(), &type, name.c_str(), nullptr, nullptr);
  const dds_entity_t writer =
      topic < 0 ? topic : dds_create_writer(participant.entity(), topic, qos, nullptr);
  dds_delete_qos(qos);
  return require(writer);
}

Header headerOf(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {static_cast<std::int32_t>(time_ns / kSecond_ns), static_cast<std::uint32_t>(time_ns % kSecond_ns),
          const_cast<char*>(kWorld)};
}

void setPose(double (&to)[7], const Pose& X) {
  const Eigen::Quaterniond q(X.R);
  const double values[7] = {X.p.x(), X.p.y(), X.p.z(), q.x(), q.y(), q.z(), q.w()};
  std::copy(std::begin(values), std::end(values), std::begin(to));
}

}  // namespace

struct RosTopics::Work {
  Work(int domain, const std::string& interface, const std::string& session, const Scene& scene)
      : participant(SessionNetwork(interface, "none"), domain) {
    const std::string name = rosName(session);
    const dds_topic_descriptor_t pose_type =
        descriptor(ros::kPoseName, sizeof(PoseStamped), ros::kPoseOps, ros::kPoseInstructions);
    const dds_topic_descriptor_t wrench_type =
        descriptor("geometry_msgs::msg::dds_::WrenchStamped_", sizeof(WrenchStamped), kWrenchOps, 5);
    const dds_topic_descriptor_t tf_type =
        descriptor("tf2_msgs::msg::dds_::TFMessage_", sizeof(TfMessage), kTfOps, 8);
    handle = makeWriter(participant, "rt/vps/" + name + "/handle", pose_type, 10);
    force = makeWriter(participant, "rt/vps/" + name + "/force", wrench_type, 10);
    tf = makeWriter(participant, "rt/tf", tf_type, 100);
    for (const ScenePart& part : scene.parts) frames.push_back(name + "/" + rosName(part.part.name));
  }

  DdsParticipant participant;  // deleting the participant deletes its writers
  dds_entity_t handle = 0, force = 0, tf = 0;
  std::vector<std::string> frames;
  std::vector<TransformStamped> transforms;
};

RosTopics::RosTopics(int domain, const std::string& interface, const std::string& session, const Scene& scene)
    : work_(std::make_unique<Work>(domain, interface, session, scene)) {}
RosTopics::~RosTopics() = default;

void RosTopics::publish(const Snapshot& shot, std::int64_t time_ns) {
  const Header header = headerOf(time_ns);
  if (shot.has_hand) {
    PoseStamped pose{header, {}};
    setPose(pose.pose, shot.X_W_Proxy);
    dds_write(work_->handle, &pose);
  }
  work_->transforms.clear();
  for (const BodySnapshot& body : shot.bodies) {
    if (body.role == BodyRole::Waiting || body.part >= work_->frames.size()) continue;
    TransformStamped transform{header, work_->frames[body.part].data(), {}};
    setPose(transform.transform, body.X_WP);
    work_->transforms.push_back(transform);
  }
  if (work_->transforms.empty()) return;
  TfMessage message{};
  message.transforms._maximum = message.transforms._length =
      static_cast<std::uint32_t>(work_->transforms.size());
  message.transforms._buffer = reinterpret_cast<std::uint8_t*>(work_->transforms.data());
  dds_write(work_->tf, &message);
}

void RosTopics::publish(const Wrench& F_hand_W, std::int64_t time_ns) {
  WrenchStamped wrench{
      headerOf(time_ns),
      {F_hand_W.f.x(), F_hand_W.f.y(), F_hand_W.f.z(), F_hand_W.tau.x(), F_hand_W.tau.y(), F_hand_W.tau.z()}};
  dds_write(work_->force, &wrench);
}

struct HeadTopic::Work {
  Work(const std::string& topic, int domain, const std::string& interface)
      : participant(SessionNetwork(interface, "none"), domain) {
    const dds_topic_descriptor_t type =
        ros::descriptor(ros::kPoseName, sizeof(ros::PoseStamped), ros::kPoseOps, ros::kPoseInstructions);
    const dds_entity_t name =
        ros::require(dds_create_topic(participant.entity(), &type, ("rt" + topic).c_str(), nullptr, nullptr));
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT,
                         0);  // a best-effort reader matches reliable writers, too
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    reader = dds_create_reader(participant.entity(), name, qos, nullptr);
    dds_delete_qos(qos);
    ros::require(reader);
  }

  DdsParticipant participant;  // deleting the participant deletes its reader
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
