// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 message types, described for Cyclone DDS. The layouts are those of ROS 2's common_interfaces. Nested
// structures are flattened, which does not change the bytes on the wire.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>

namespace vps::scenes::ros {

struct Header {
  std::int32_t sec;
  std::uint32_t nanosec;
  char* frame;
};
struct PoseStamped {
  Header header;
  double pose[7];  ///< position, then orientation x y z w
};

inline constexpr std::uint32_t kNumber = static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_4BY;
inline constexpr std::uint32_t kText = static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_STR;
inline constexpr std::uint32_t kDoubles =
    static_cast<std::uint32_t>(DDS_OP_ADR) | DDS_OP_TYPE_ARR | DDS_OP_SUBTYPE_8BY;
inline constexpr std::uint32_t kPoseOps[] = {kNumber,  offsetof(PoseStamped, header.sec),
                                             kNumber,  offsetof(PoseStamped, header.nanosec),
                                             kText,    offsetof(PoseStamped, header.frame),
                                             kDoubles, offsetof(PoseStamped, pose),
                                             7,        DDS_OP_RTS};
inline constexpr std::uint32_t kPoseInstructions = 5;
inline constexpr const char* kPoseName = "geometry_msgs::msg::dds_::PoseStamped_";

/// @param instructions  number of instructions in ops
dds_topic_descriptor_t descriptor(const char* name, std::size_t size, const std::uint32_t* ops,
                                  std::uint32_t instructions);
/// Returns the entity. Throws LoadError if DDS refused to make it.
dds_entity_t require(dds_entity_t made);

}  // namespace vps::scenes::ros
