// SPDX-License-Identifier: BSD-3-Clause
// Replaces the other sources of this folder if Cyclone DDS is missing.
#include "link/link.h"
#include "requests/request_channel.h"
#include "vps/errors.h"
#include "vps_scenes/network/ros_topics.h"

namespace vps::scenes {

namespace {

[[noreturn]] void refuseNetwork() {
  throw LoadError("", "",
                  "this build has no network support, only shared memory; leave out --network, or build with "
                  "Cyclone DDS (Debian: cyclonedds-dev)");
}

}  // namespace

std::unique_ptr<Link> makeNetworkSession(const std::string&, std::string_view, const SessionNetwork&) {
  refuseNetwork();
}
std::unique_ptr<Link> joinNetworkSession(const std::string&, NodeRole, const SessionNetwork&) {
  refuseNetwork();
}

std::unique_ptr<PointerTopic> makePointerTopic(const std::string&, const SessionNetwork&) {
  refuseNetwork();
}

std::unique_ptr<ServerChannel> makeNetworkServer(const std::string&, const SessionNetwork&) {
  refuseNetwork();
}
std::unique_ptr<ClientChannel> findNetworkServer(const std::string&, const SessionNetwork&) {
  refuseNetwork();
}

struct RosTopics::Work {};
RosTopics::RosTopics(int, const std::string&, const std::string&, const Scene&) {
  refuseNetwork();
}
RosTopics::~RosTopics() = default;
void RosTopics::publish(const Snapshot&, std::int64_t) {}
void RosTopics::publish(const Wrench&, std::int64_t) {}

struct HeadTopic::Work {};
HeadTopic::HeadTopic(const std::string& topic, int, const std::string&) {
  throw LoadError("", "",
                  "this build has no network support, so '" + topic +
                      "' delivers no head poses; use 'head' or 'recorded' instead, or build with Cyclone DDS "
                      "(Debian: cyclonedds-dev)");
}
HeadTopic::~HeadTopic() = default;
std::optional<Pose> HeadTopic::take() {
  return {};
}

}  // namespace vps::scenes
