// SPDX-License-Identifier: BSD-3-Clause
// Each process that points has its own small region, in one of a few slots, which only this process writes: a
// session's region has one writer for each channel, and watchers map it read-only. Over a network all
// watchers write and read one topic, and each sender is assigned a slot number.
#include "vps_scenes/network/session_pointers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include "link/broadcast_ring.h"
#include "link/link.h"
#include "link/shared_region.h"
#include "messages/messages.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

namespace {

constexpr RingShape kPointerRing{64, 1024};
constexpr std::size_t kPointerBytes = 8 * kPointerRing.words();
constexpr double kLookEach_s = 0.25;    // interval of searches for processes that came or ended
constexpr double kRepeatEach_s = 0.5;   // assumed: a watcher who joins later does not notice this delay
constexpr std::size_t kMostShown = 64;  // limit of persons of one process
constexpr double kGone_s = 2;  // over a network: a sender that was silent for this time no longer points

/// Another process that points.
struct Other {
  SharedRegion region;  ///< not open over a network
  RingReader ring;
  MessageReader reader;
  std::uint64_t sender = 0;   ///< used over a network only
  double heard_s = 0;         ///< used over a network only: time of the last message
  std::map<int, Vec3> shown;  ///< shown places by person
};

}  // namespace

struct SessionPointers::Work {
  Work(std::string name, const SessionNetwork& network) : session(std::move(name)) {
    if (!network.empty()) topic = makePointerTopic(session, network);
  }

  [[nodiscard]] std::string slotName(int slot) const { return session + ".pointer" + std::to_string(slot); }
  [[nodiscard]] static int whoOf(int slot, int person) { return 1000 * (slot + 1) + person; }

  /// The region of a slot if its process is alive; otherwise not open.
  [[nodiscard]] SharedRegion openSlot(int slot) const {
    try {
      SharedRegion region = SharedRegion::open(slotName(slot), false);
      const bool is_whole = region.isOpen() && region.memory().size() >= kPointerBytes;
      return is_whole && region.isTaken(NodeRole::Render) ? std::move(region) : SharedRegion();
    } catch (const LoadError&) {  // the region is accessible to other users, so it is not trusted
      return {};
    }
  }
  void takeSlot() {
    for (int slot = 0; slot < kMostPointing && !own.isOpen(); ++slot) {
      if (openSlot(slot).isOpen()) continue;
      try {
        own = SharedRegion::create(slotName(slot), kPointerBytes);
        own_slot = slot;
        writer = RingWriter(reinterpret_cast<SharedWord*>(own.memory().data()), kPointerRing);
      } catch (const LoadError&) {  // another process has taken the slot
      }
    }
  }
  [[nodiscard]] bool canSend() {
    if (topic == nullptr && !own.isOpen()) takeSlot();
    return topic != nullptr || own.isOpen();
  }
  void send(int person, const std::optional<Vec3>& p_W) {
    PointerMessage message;
    message.person = static_cast<std::uint32_t>(person);
    message.is_shown = p_W.has_value();
    if (p_W) message.p_W = *p_W;
    if (topic != nullptr)
      topic->send(messages.write(message));
    else
      writer.write(messages.write(message));
  }
  void repeat(double now_s) {
    if (now_s < next_repeat_s) return;
    next_repeat_s = now_s + kRepeatEach_s;
    for (const auto& [person, p_W] : pointing) send(person, p_W);
  }
  void leave(int slot, std::vector<SessionPointer>& changes) {
    std::optional<Other>& other = others[static_cast<std::size_t>(slot)];
    for (const auto& [person, p_W] : other->shown) changes.push_back({whoOf(slot, person), {}});
    other.reset();
  }
  void look(double now_s, std::vector<SessionPointer>& changes) {
    if (now_s < next_look_s) return;
    next_look_s = now_s + kLookEach_s;
    for (int slot = 0; slot < kMostPointing; ++slot) {
      if (slot == own_slot) continue;
      std::optional<Other>& other = others[static_cast<std::size_t>(slot)];
      if (other && !other->region.isTaken(NodeRole::Render)) leave(slot, changes);
      if (other) continue;
      SharedRegion region = openSlot(slot);
      if (!region.isOpen()) continue;
      other.emplace();
      other->ring = RingReader(reinterpret_cast<const SharedWord*>(region.memory().data()), kPointerRing);
      other->region = std::move(region);
    }
  }
  void readRings(std::vector<SessionPointer>& changes) {
    PointerMessage message;
    for (int slot = 0; slot < kMostPointing; ++slot) {
      std::optional<Other>& other = others[static_cast<std::size_t>(slot)];
      if (!other) continue;
      for (std::string_view bytes; !(bytes = other->ring.next(buffer)).empty();)
        if (other->reader.read(bytes, message) == Reading::Good) accept(slot, *other, message, changes);
    }
  }
  void readTopic(double now_s, std::vector<SessionPointer>& changes) {
    for (const std::string& bytes : topic->take()) {
      MessageReader any;
      PointerMessage message;
      if (any.read(bytes, message) != Reading::Good || any.envelope().sender == messages.sender()) continue;
      const int slot = slotOf(any.envelope().sender);
      if (slot < 0) continue;
      Other& other = *others[static_cast<std::size_t>(slot)];
      if (other.reader.read(bytes, message) != Reading::Good)
        continue;  // the message is invalid or older than an earlier message
      other.heard_s = now_s;
      accept(slot, other, message, changes);
    }
    for (int slot = 0; slot < kMostPointing; ++slot)
      if (const auto& other = others[static_cast<std::size_t>(slot)];
          other && now_s > other->heard_s + kGone_s)
        leave(slot, changes);
  }
  /// Slot of a sender; a new sender gets a free slot. Negative: all slots are in use.
  int slotOf(std::uint64_t sender) {
    int free = -1;
    for (int slot = 0; slot < kMostPointing; ++slot) {
      const std::optional<Other>& other = others[static_cast<std::size_t>(slot)];
      if (other && other->sender == sender) return slot;
      if (!other && free < 0) free = slot;
    }
    if (free >= 0) others[static_cast<std::size_t>(free)].emplace().sender = sender;
    return free;
  }
  static void accept(int slot, Other& other, const PointerMessage& message,
                     std::vector<SessionPointer>& changes) {
    const auto person = static_cast<int>(std::min<std::uint32_t>(message.person, kMostPersons + 1));
    if (person < 1 || person > kMostPersons) return;
    const auto found = other.shown.find(person);
    const bool is_known = found != other.shown.end();
    if (!message.is_shown) {
      if (!is_known) return;
      other.shown.erase(found);
      changes.push_back({whoOf(slot, person), {}});
      return;
    }
    if (is_known ? found->second == message.p_W : other.shown.size() >= kMostShown) return;
    other.shown[person] = message.p_W;
    changes.push_back({whoOf(slot, person), message.p_W});
  }

  std::string session;
  std::unique_ptr<PointerTopic> topic;  ///< null: shared memory is used
  SharedRegion own;                     ///< not open before this process points
  int own_slot = -1;
  RingWriter writer;
  MessageWriter messages{newSender()};
  std::map<int, Vec3> pointing;  ///< places by person of this process
  std::array<std::optional<Other>, kMostPointing> others;
  std::array<char, kPointerRing.bytes> buffer{};
  double next_look_s = 0, next_repeat_s = 0;
};

SessionPointers::SessionPointers(const std::string& session, const SessionNetwork& network) {
  requireSessionName(session);
  work_ = std::make_unique<Work>(session, network);
}
SessionPointers::~SessionPointers() = default;

void SessionPointers::point(int person, const std::optional<Vec3>& p_W) {
  if (person < 1 || person > kMostPersons || (p_W && !p_W->allFinite())) return;
  if (p_W)
    work_->pointing[person] = *p_W;
  else if (work_->pointing.erase(person) == 0)
    return;
  if (work_->canSend()) work_->send(person, p_W);
}

std::vector<SessionPointer> SessionPointers::take() {
  std::vector<SessionPointer> changes;
  const double now_s = device::monotonicSeconds();
  if (work_->topic != nullptr) {
    work_->repeat(now_s);
    work_->readTopic(now_s, changes);
    return changes;
  }
  if (work_->own.isOpen()) work_->repeat(now_s);
  work_->look(now_s, changes);
  work_->readRings(changes);
  return changes;
}

}  // namespace vps::scenes
