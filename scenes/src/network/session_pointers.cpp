// SPDX-License-Identifier: BSD-3-Clause
// Each process that points has a small region of its own, in one of a few slots, which it alone writes: a
// session's region has one writer for each channel, and watchers map it for reading only.
#include "vps_scenes/network/session_pointers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include "network/broadcast_ring.h"
#include "network/messages.h"
#include "network/shared_region.h"
#include "vps/load_error.h"
#include "vps_device/metronome.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr RingShape kPointerRing{64, 1024};
constexpr std::size_t kPointerBytes = 8 * kPointerRing.words();
constexpr double kLookEach_s = 0.25;    // for processes that came or went
constexpr double kRepeatEach_s = 0.5;   // assumed: who comes later does not notice this delay
constexpr std::size_t kMostShown = 64;  // persons of one process

double pointerClock_s() {
  return 1e-9 * static_cast<double>(device::monotonicClock().now_ns());
}

/// Another process that points.
struct Other {
  explicit Other(SharedRegion opened)
      : region(std::move(opened)),
        ring(reinterpret_cast<const SharedWord*>(region.memory().data()), kPointerRing) {}
  SharedRegion region;
  RingReader ring;
  MessageReader reader;
  std::map<int, Vec3> shown;  ///< by person
};

}  // namespace

struct SessionPointers::Work {
  explicit Work(std::string name) : session(std::move(name)) {}

  [[nodiscard]] std::string slotName(int slot) const { return session + ".pointer" + std::to_string(slot); }
  [[nodiscard]] static int whoOf(int slot, int person) { return 1000 * (slot + 1) + person; }

  /// Where a process that is alive points from; not open: from nowhere.
  [[nodiscard]] SharedRegion openSlot(int slot) const {
    try {
      SharedRegion region = SharedRegion::open(slotName(slot), false);
      const bool is_whole = region.isOpen() && region.memory().size() >= kPointerBytes;
      return is_whole && region.isTaken(NodeRole::Render) ? std::move(region) : SharedRegion();
    } catch (const LoadError&) {  // open to others, so not to be believed
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
      } catch (const LoadError&) {  // another process was quicker
      }
    }
  }
  void send(int person, const std::optional<Vec3>& p_W) {
    PointerMessage message;
    message.person = static_cast<std::uint32_t>(person);
    message.is_shown = p_W.has_value();
    if (p_W) message.p_W = *p_W;
    writer.write(messages.write(message));
  }
  void repeat(double now_s) {
    if (now_s < next_repeat_s) return;
    next_repeat_s = now_s + kRepeatEach_s;
    for (const auto& [person, p_W] : pointing) send(person, p_W);
  }
  void look(double now_s, std::vector<SessionPointer>& changes) {
    if (now_s < next_look_s) return;
    next_look_s = now_s + kLookEach_s;
    for (int slot = 0; slot < kMostPointing; ++slot) {
      if (slot == own_slot) continue;
      std::optional<Other>& other = others[static_cast<std::size_t>(slot)];
      if (other && !other->region.isTaken(NodeRole::Render)) {
        for (const auto& [person, p_W] : other->shown) changes.push_back({whoOf(slot, person), {}});
        other.reset();
      }
      if (other) continue;
      if (SharedRegion region = openSlot(slot); region.isOpen()) other.emplace(std::move(region));
    }
  }
  void read(int slot, Other& other, std::vector<SessionPointer>& changes) {
    PointerMessage message;
    for (std::string_view bytes; !(bytes = other.ring.next(buffer)).empty();) {
      if (other.reader.read(bytes, message) != Reading::Good) continue;
      const auto person = static_cast<int>(std::min<std::uint32_t>(message.person, kMostPersons + 1));
      if (person < 1 || person > kMostPersons) continue;
      const auto found = other.shown.find(person);
      if (!message.is_shown) {
        if (found == other.shown.end()) continue;
        other.shown.erase(found);
        changes.push_back({whoOf(slot, person), {}});
        continue;
      }
      const bool is_known = found != other.shown.end();
      if (is_known ? found->second == message.p_W : other.shown.size() >= kMostShown) continue;
      other.shown[person] = message.p_W;
      changes.push_back({whoOf(slot, person), message.p_W});
    }
  }

  std::string session;
  SharedRegion own;  ///< not open until this process points
  int own_slot = -1;
  RingWriter writer;
  MessageWriter messages{newSender()};
  std::map<int, Vec3> pointing;  ///< by person of this process
  std::array<std::optional<Other>, kMostPointing> others;
  std::array<char, kPointerRing.bytes> buffer{};
  double next_look_s = 0, next_repeat_s = 0;
};

SessionPointers::SessionPointers(const std::string& session) : work_(std::make_unique<Work>(session)) {
  requireSessionName(session);
}
SessionPointers::~SessionPointers() = default;

void SessionPointers::point(int person, const std::optional<Vec3>& p_W) {
  if (person < 1 || person > kMostPersons || (p_W && !p_W->allFinite())) return;
  if (p_W)
    work_->pointing[person] = *p_W;
  else if (work_->pointing.erase(person) == 0)
    return;
  if (!work_->own.isOpen()) work_->takeSlot();
  if (work_->own.isOpen()) work_->send(person, p_W);
}

std::vector<SessionPointer> SessionPointers::take() {
  std::vector<SessionPointer> changes;
  const double now_s = pointerClock_s();
  if (work_->own.isOpen()) work_->repeat(now_s);
  work_->look(now_s, changes);
  for (int slot = 0; slot < kMostPointing; ++slot)
    if (auto& other = work_->others[static_cast<std::size_t>(slot)]) work_->read(slot, *other, changes);
  return changes;
}

}  // namespace vps::scenes::inline v0
