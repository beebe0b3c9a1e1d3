// SPDX-License-Identifier: BSD-3-Clause
// Topics of a session in DDS, as C++ objects.
#pragma once

#include <dds/dds.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// A participant in a domain of one network interface. Throws LoadError where the system refuses, and where
/// the network needs certificates and has none.
class DdsParticipant {
 public:
  /// @param domain  of other programs; negative: that of sessions
  explicit DdsParticipant(const SessionNetwork& network, int domain = -1);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;
  [[nodiscard]] dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_ = 0;
};

enum class Delivery {
  Newest,    ///< best effort, and only the last one counts
  Reliable,  ///< each one, in order
  Kept,      ///< reliable; the last one is given to those who come later
};

/// The name in DDS of what a session has under that name.
std::string topicName(const std::string& session, const std::string& name);

/// What a topic carries.
enum class TopicType {
  Message,  ///< in IDL: struct Message { sequence<octet> bytes; };
  State,    ///< struct State { octet bytes[40]; }; a dense state, whose time of sending is that of the sample
};

/// Bytes that are published, or received, under a name.
class DdsTopic {
 public:
  /// @param receive  called by a thread of DDS, one call at a time; empty: the topic is written
  DdsTopic(const DdsParticipant& participant, const std::string& name, Delivery delivery,
           std::function<void(std::string_view bytes)> receive, TopicType type = TopicType::Message);
  ~DdsTopic();
  DdsTopic(const DdsTopic&) = delete;
  DdsTopic& operator=(const DdsTopic&) = delete;

  void write(std::string_view bytes);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes
