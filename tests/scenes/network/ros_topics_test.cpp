// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 topics as bytes on the wire. No ROS installation is used; the expected bytes were written by hand.
#include "vps_scenes/network/ros_topics.h"

#include <gtest/gtest.h>

#include <string>

#include "scenes/two_pins.h"
#include "vps/errors.h"

#if __has_include(<dds/dds.h>)
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#endif

namespace vps::scenes {
namespace {

TEST(RosTopics, NamesAreThoseThatRosAllows) {
  EXPECT_EQ(rosName("peg <1>"), "peg__1_");
  EXPECT_EQ(rosName("3rd"), "_3rd");
  EXPECT_EQ(rosName(""), "_");
}

#if __has_include(<dds/dds.h>)

/// Bytes as hexadecimal digits.
std::string hex(const std::string& bytes) {
  std::string text;
  for (const unsigned char c : bytes) {
    text += "0123456789abcdef"[c >> 4U];
    text += "0123456789abcdef"[c & 15U];
  }
  return text;
}

/// Receives samples as any DDS participant does under the name and type of a ROS 2 node. The subscriber's
/// type is plain bytes, so that it shares no description with the sender.
class Subscriber {
 public:
  Subscriber(int domain, const char* topic, const char* type, const std::uint32_t* ops, std::uint32_t count) {
    const dds_topic_descriptor_t descriptor = {.m_size = 256,
                                               .m_align = 8,
                                               .m_flagset = 0,
                                               .m_nkeys = 0,
                                               .m_typename = type,
                                               .m_keys = nullptr,
                                               .m_nops = count,
                                               .m_ops = ops,
                                               .m_meta = "",
                                               .type_information = {},
                                               .type_mapping = {},
                                               .restrict_data_representation = 0};
    participant_ = dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
    const dds_entity_t handle = dds_create_topic(participant_, &descriptor, topic, nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));  // ROS 2's default
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
    reader_ = dds_create_reader(participant_, handle, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~Subscriber() { dds_delete(participant_); }

  /// The next sample with its encapsulation header; empty: none within 5 s.
  template <typename Publish>
  std::string next(const Publish& publish) {
    for (int i = 0; i < 500; ++i) {
      publish();
      ddsi_serdata* sample = nullptr;
      dds_sample_info_t info{};
      if (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) == 1) {
        std::string bytes(ddsi_serdata_size(sample), '\0');
        ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
        ddsi_serdata_unref(sample);
        if (info.valid_data) return bytes;
      }
      dds_sleepfor(DDS_MSECS(10));
    }
    return {};
  }

 private:
  dds_entity_t participant_ = 0, reader_ = 0;
};

constexpr int kDomain = 101;
constexpr std::int64_t kTime_ns = 1'700'000'000'000'000'005;  // 0x6553f100 s, 5 ns

constexpr std::uint32_t op(std::uint32_t type, std::uint32_t subtype = 0) {
  return static_cast<std::uint32_t>(DDS_OP_ADR) | type | subtype;
}
constexpr std::uint32_t kStampedPose[] = {
    op(DDS_OP_TYPE_4BY), 0,  op(DDS_OP_TYPE_4BY), 4,  op(DDS_OP_TYPE_STR), 8,  op(DDS_OP_TYPE_8BY), 16,
    op(DDS_OP_TYPE_8BY), 24, op(DDS_OP_TYPE_8BY), 32, op(DDS_OP_TYPE_8BY), 40, op(DDS_OP_TYPE_8BY), 48,
    op(DDS_OP_TYPE_8BY), 56, op(DDS_OP_TYPE_8BY), 64, DDS_OP_RTS};
constexpr std::uint32_t kStampedWrench[] = {
    op(DDS_OP_TYPE_4BY), 0,  op(DDS_OP_TYPE_4BY), 4,  op(DDS_OP_TYPE_STR), 8,  op(DDS_OP_TYPE_8BY), 16,
    op(DDS_OP_TYPE_8BY), 24, op(DDS_OP_TYPE_8BY), 32, op(DDS_OP_TYPE_8BY), 40, op(DDS_OP_TYPE_8BY), 48,
    op(DDS_OP_TYPE_8BY), 56, DDS_OP_RTS};

Scene onePart() {
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].part.name = "peg 1";
  return scene;
}

Snapshot onePose() {
  Snapshot shot;
  shot.has_hand = true;
  shot.X_W_Proxy = Pose::translation(Vec3(1, -2, 0.5));
  shot.bodies = {{0, Pose::translation(Vec3(0, 0, 2)), BodyRole::InHand}};
  return shot;
}

// Encapsulation CDR_LE; stamp; "world" with its length and terminator, padded to 8 bytes from the start of
// the data.
const std::string kEncapsulation = "00010000";
const std::string kHeader =
    "00f15365"
    "05000000"
    "06000000"
    "776f726c6400";

TEST(RosTopics, APoseHasTheBytesOfGeometryMsgs) {
  RosTopics topics(kDomain, "lo", "s-1", onePart());
  Subscriber subscriber(kDomain, "rt/vps/s_1/handle", "geometry_msgs::msg::dds_::PoseStamped_", kStampedPose,
                        10);
  const std::string bytes = subscriber.next([&] { topics.publish(onePose(), kTime_ns); });
  EXPECT_EQ(hex(bytes), kEncapsulation + kHeader +
                            "000000000000"
                            "000000000000f03f"
                            "00000000000000c0"
                            "000000000000e03f"
                            "0000000000000000"
                            "0000000000000000"
                            "0000000000000000"
                            "000000000000f03f");
}

TEST(RosTopics, AWrenchHasTheBytesOfGeometryMsgs) {
  RosTopics topics(kDomain, "lo", "s-1", onePart());
  Subscriber subscriber(kDomain, "rt/vps/s_1/force", "geometry_msgs::msg::dds_::WrenchStamped_",
                        kStampedWrench, 9);
  Wrench F_W;
  F_W.f = Vec3(1, 2, -1);
  F_W.tau = Vec3(0.5, 0, 0);
  const std::string bytes = subscriber.next([&] { topics.publish(F_W, kTime_ns); });
  EXPECT_EQ(hex(bytes), kEncapsulation + kHeader +
                            "000000000000"
                            "000000000000f03f"
                            "0000000000000040"
                            "000000000000f0bf"
                            "000000000000e03f"
                            "0000000000000000"
                            "0000000000000000");
}

constexpr std::uint32_t kTfMessage[] = {op(DDS_OP_TYPE_SEQ, DDS_OP_SUBTYPE_STU),
                                        0,
                                        80,
                                        (4U << 16U) + 5U,
                                        DDS_OP_RTS,
                                        op(DDS_OP_TYPE_4BY),
                                        0,
                                        op(DDS_OP_TYPE_4BY),
                                        4,
                                        op(DDS_OP_TYPE_STR),
                                        8,
                                        op(DDS_OP_TYPE_STR),
                                        16,
                                        op(DDS_OP_TYPE_ARR, DDS_OP_SUBTYPE_8BY),
                                        24,
                                        7,
                                        DDS_OP_RTS};

TEST(RosTopics, ATransformHasTheBytesOfTf2Msgs) {
  RosTopics topics(kDomain, "lo", "s-1", onePart());
  Subscriber subscriber(kDomain, "rt/tf", "tf2_msgs::msg::dds_::TFMessage_", kTfMessage, 8);
  const std::string bytes = subscriber.next([&] { topics.publish(onePose(), kTime_ns); });
  // One transform; "s_1/peg_1" is 10 bytes with its terminator.
  EXPECT_EQ(hex(bytes), kEncapsulation + "01000000" + kHeader +
                            "0000"
                            "0a000000"
                            "735f312f7065675f3100"
                            "0000" +

                            "0000000000000000"
                            "0000000000000000"
                            "0000000000000040" +
                            "0000000000000000"
                            "0000000000000000"
                            "0000000000000000"
                            "000000000000f03f");
}

#endif

}  // namespace
}  // namespace vps::scenes
