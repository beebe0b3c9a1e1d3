// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "link/clock_estimate.h"
#include "link/link.h"
#include "messages/messages.h"
#include "record/scene_archive.h"
#include "vps_device/metronome.h"
#include "vps_scenes/network/nodes.h"

namespace vps::scenes {

struct SessionWatcher::Work {
  explicit Work(std::unique_ptr<Link> joined, const std::string& session)
      : link(std::move(joined)),
        scene(sceneFromBytes(link->sceneBytes(), sessionWords(session))),
        buffer(kLongestMessage) {
    reader.bindTo(link->sessionId());
  }

  std::unique_ptr<Link> link;
  Scene scene;
  std::vector<char> buffer;
  MessageReader reader;         ///< reader of the render node's messages
  std::int64_t shot_ns = 0;     ///< sending time of the last snapshot, by the render node's clock
  MessageReader device_reader;  ///< reader of any device's messages
  ClockDoubts doubts;
  HapticMessage haptic;  ///< the last message; a compact message updates only a part of its values
};

SessionWatcher::SessionWatcher(std::unique_ptr<Work> work) : work_(std::move(work)) {}
SessionWatcher::~SessionWatcher() = default;

std::unique_ptr<SessionWatcher> SessionWatcher::join(const std::string& session,
                                                     const SessionNetwork& network) {
  std::unique_ptr<Link> link = joinSession(session, NodeRole::Watch, network);
  if (link == nullptr) return nullptr;
  return std::unique_ptr<SessionWatcher>(
      new SessionWatcher(std::make_unique<Work>(std::move(link), session)));
}

const Scene& SessionWatcher::scene() const {
  return work_->scene;
}

std::optional<Snapshot> SessionWatcher::takeSnapshot() {
  SnapshotMessage message;
  const std::string_view bytes = work_->link->receive(Channel::Snapshot, work_->buffer);
  if (bytes.empty() || work_->reader.read(bytes, message) != Reading::Good) return {};
  work_->shot_ns = work_->reader.envelope().time_ns;
  const int step = message.snapshot.step;  // -1: no step is active
  if (step < -1 || std::cmp_greater_equal(step, work_->scene.steps.size())) return {};
  const std::size_t parts = work_->scene.parts.size();
  for (const BodySnapshot& body : message.snapshot.bodies)
    if (body.part >= parts) return {};
  if (message.snapshot.has_target && message.snapshot.target_part >= parts) return {};
  return std::move(message.snapshot);
}

std::int64_t SessionWatcher::snapshotSent_ns() const {
  const std::int64_t now_ns = device::monotonicClock().now_ns();
  if (work_->link->form() == WireForm::Exact) return work_->shot_ns;  // by the clock of this machine
  const std::optional<PeerTiming> timing = work_->link->timing(NodeRole::Render);
  return timing ? sentByClockHere_ns(work_->shot_ns, timing->clock_offset_s, now_ns) : now_ns;
}

std::optional<SessionNews> SessionWatcher::takeNews() {
  NewsMessage message;
  const std::string_view bytes = work_->link->receive(Channel::News, work_->buffer);
  if (bytes.empty() || work_->reader.read(bytes, message) != Reading::Good) return {};
  return SessionNews{static_cast<SessionNews::Kind>(message.kind), message.step, message.verdict,
                     message.time_s, message.text.data()};
}

std::optional<SessionForce> SessionWatcher::takeForce() {
  const std::string_view bytes = work_->link->receive(Channel::Haptic, work_->buffer);
  if (bytes.empty() || work_->device_reader.read(bytes, work_->haptic) != Reading::Good) return {};
  const device::HapticState& state = work_->haptic.state;
  return SessionForce{state.report.time_s, work_->device_reader.envelope().time_ns, state.report.F_hand_W,
                      state.proxy.is_coupled, state.safety.fault != device::SafetyFault::None};
}

bool SessionWatcher::hasEnded() const {
  return work_->link->hasEnded();
}
bool SessionWatcher::isOver() const {
  return hasEnded() || !work_->link->isAlive(NodeRole::Render);
}
bool SessionWatcher::hasDevice() const {
  return work_->link->isAlive(NodeRole::Device);
}
std::uint64_t SessionWatcher::refused() const {
  return work_->reader.refused() + work_->device_reader.refused() + work_->link->refusedBeats();
}
std::vector<std::string> SessionWatcher::takeDoubts() {
  return work_->doubts.takeNew(*work_->link);
}

}  // namespace vps::scenes
