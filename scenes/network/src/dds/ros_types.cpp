// SPDX-License-Identifier: BSD-3-Clause
#include "dds/ros_types.h"

#include <string>

#include "vps/errors.h"

namespace vps::scenes::ros {

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

dds_entity_t require(dds_entity_t made) {
  if (made >= 0) return made;
  throw LoadError("", "", std::string("the topics of ROS 2: ") + dds_strretcode(-made));
}

}  // namespace vps::scenes::ros
