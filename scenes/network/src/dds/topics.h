// SPDX-License-Identifier: BSD-3-Clause
// DDS participants and topics of a session, as C++ objects; access control by DDS-Security.
#pragma once

#include <dds/dds.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// A participant in the domain of one network interface. Throws LoadError if the system refuses, or if the
/// network needs certificates and none are given.
class DdsParticipant {
 public:
  /// @param domain  domain of other programs; negative: the domain of sessions
  explicit DdsParticipant(const SessionNetwork& network, int domain = -1);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;
  [[nodiscard]] dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_ = 0;
};

enum class Delivery {
  Newest,    ///< best effort; only the newest message counts
  Reliable,  ///< all messages, in order
  Kept,      ///< reliable; late joiners get the last message
};

/// DDS topic name of a session's topic.
std::string topicName(const std::string& session, const std::string& name);

/// Data type of a topic.
enum class TopicType {
  Message,  ///< in IDL: struct Message { sequence<octet> bytes; };
  State,    ///< in IDL: struct State { octet bytes[40]; }; a dense state, whose sending time is the DDS
            ///< sample's timestamp
};

/// A topic that is either written or received.
class DdsTopic {
 public:
  /// @param receive  called by a thread of DDS, one call at a time; empty: the topic is for writing
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

/// The part of Cyclone DDS's settings that names certificates and plugins; empty: without security. Throws
/// LoadError if a file or the plugins are missing, or if the network is reachable from other machines and no
/// certificates are given.
std::string securitySettings(const SessionNetwork& network, bool is_loopback);

}  // namespace vps::scenes
