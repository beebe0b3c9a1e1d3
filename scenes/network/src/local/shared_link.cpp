// SPDX-License-Identifier: BSD-3-Clause
// The link in shared memory: a header, a ring for each channel, and the scene.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <optional>

#include "link/link.h"
#include "messages/messages.h"
#include "vps/errors.h"
#include "vps_device/periodic_thread.h"

namespace vps::scenes {

namespace {

constexpr std::uint64_t kMagic = 0x76707331'00000000;  // "vps1", combined with the version of the messages
constexpr std::uint64_t kScheme = kMagic | kMessageVersion;

enum class SessionState : std::uint64_t { Making, Open, Ended };

/// Words of the header. Each word is written once before the session's state becomes Open, except kSigns,
/// which counts while the session is open.
enum Head : std::size_t { kState, kSchemeWord, kIdentity, kSceneSize, kSigns, kHeadWords = 8 };

constexpr std::size_t offsetOf(std::size_t channel) {
  std::size_t words = kHeadWords;
  for (std::size_t i = 0; i < channel; ++i) words += kChannelShapes[i].words();
  return words;
}
constexpr std::size_t kSceneOffset = 8 * offsetOf(kChannels);  // [bytes]

class SharedLink final : public Link {
 public:
  SharedLink(SharedRegion region, NodeRole role) : region_(std::move(region)), role_(role) {
    SharedWord* words = head();
    for (std::size_t i = 0; i < kChannels; ++i) {
      SharedWord* ring = words + offsetOf(i);
      if (writerOf(static_cast<Channel>(i)) == role)
        writers_[i] = RingWriter(ring, kChannelShapes[i]);
      else
        readers_[i] = RingReader(ring, kChannelShapes[i]);
    }
    // A new device skips requests to an earlier device; a watcher starts with new messages.
    if (role == NodeRole::Device) reader(Channel::Request).skip();
    if (role == NodeRole::Watch)
      for (const Channel channel : {Channel::Request, Channel::Reply, Channel::Log}) reader(channel).skip();
  }
  ~SharedLink() override {
    if (role_ != NodeRole::Render) return;
    signs_.reset();
    head()[kState].store(static_cast<std::uint64_t>(SessionState::Ended), std::memory_order_release);
  }

  void open(std::string_view scene_bytes) {
    std::memcpy(region_.memory().data() + kSceneOffset, scene_bytes.data(), scene_bytes.size());
    head()[kSchemeWord].store(kScheme, std::memory_order_relaxed);
    head()[kIdentity].store(newSender(), std::memory_order_relaxed);
    head()[kSceneSize].store(scene_bytes.size(), std::memory_order_relaxed);
    head()[kState].store(static_cast<std::uint64_t>(SessionState::Open), std::memory_order_release);
    signs_.emplace(device::PeriodicSettings{.rate_hz = 1 / kSignPeriod_s, .priority = kLinkPriority});
    signs_->start(
        [signs = head() + kSigns](const device::Beat&) { signs->fetch_add(1, std::memory_order_relaxed); });
  }

  bool send(Channel channel, std::string_view message) noexcept override {
    return writers_[static_cast<std::size_t>(channel)].write(message);
  }
  std::string_view receive(Channel channel, std::span<char> buffer) noexcept override {
    return isState(channel) ? reader(channel).latest(buffer) : reader(channel).next(buffer);
  }
  [[nodiscard]] std::uint64_t lost(Channel channel) const noexcept override {
    return readers_[static_cast<std::size_t>(channel)].lost();
  }
  [[nodiscard]] std::uint64_t signsOfLife() const noexcept override {
    return head()[kSigns].load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool isAlive(NodeRole role) const override { return region_.isTaken(role); }
  [[nodiscard]] std::size_t watchers() const override { return region_.watchers(); }
  [[nodiscard]] std::uint64_t sessionId() const override {
    return head()[kIdentity].load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool hasEnded() const override { return state() == SessionState::Ended; }
  [[nodiscard]] std::string sceneBytes() const override {
    const std::uint64_t size = head()[kSceneSize].load(std::memory_order_relaxed);
    const std::span<std::byte> memory = region_.memory();
    if (size > memory.size() - kSceneOffset) return {};
    return {reinterpret_cast<const char*>(memory.data()) + kSceneOffset, static_cast<std::size_t>(size)};
  }

  [[nodiscard]] SessionState state() const {
    return static_cast<SessionState>(head()[kState].load(std::memory_order_acquire));
  }
  [[nodiscard]] std::uint64_t scheme() const { return head()[kSchemeWord].load(std::memory_order_relaxed); }

 private:
  [[nodiscard]] SharedWord* head() const { return reinterpret_cast<SharedWord*>(region_.memory().data()); }
  RingReader& reader(Channel channel) { return readers_[static_cast<std::size_t>(channel)]; }

  SharedRegion region_;
  NodeRole role_;
  std::array<RingWriter, kChannels> writers_;
  std::array<RingReader, kChannels> readers_;
  std::optional<device::PeriodicThread> signs_;  ///< runs in the render node only
};

}  // namespace

std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes) {
  requireSessionName(session);
  removeDeadRegions();
  auto link = std::make_unique<SharedLink>(SharedRegion::create(session, kSceneOffset + scene_bytes.size()),
                                           NodeRole::Render);
  link->open(scene_bytes);
  return link;
}

std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role) {
  requireSessionName(session);
  SharedRegion region = SharedRegion::open(session, role == NodeRole::Device);
  if (!region.isOpen() || region.memory().size() < kSceneOffset) return nullptr;
  if (!region.isTaken(NodeRole::Render)) {  // the region was left behind by a crash
    removeIfDead(session);
    return nullptr;
  }
  const auto* head = reinterpret_cast<const SharedWord*>(region.memory().data());
  if (head[kState].load(std::memory_order_acquire) != static_cast<std::uint64_t>(SessionState::Open))
    return nullptr;
  if (head[kSchemeWord].load(std::memory_order_relaxed) != kScheme)
    throw LoadError("", "",
                    sessionWords(session) +
                        " is run by another version of vps render; use the same version for all nodes");
  // A writer continues where the region's last device stopped, so it must own the role first.
  if (role == NodeRole::Device && !region.take(NodeRole::Device))
    throw LoadError("", "", sessionWords(session) + " has a device already; only one hand can hold the part");
  if (role == NodeRole::Watch) region.markWatcher();
  return std::make_unique<SharedLink>(std::move(region), role);
}

std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes,
                                  const SessionNetwork& network) {
  return network.empty() ? makeSession(session, scene_bytes)
                         : makeNetworkSession(session, scene_bytes, network);
}

std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role, const SessionNetwork& network) {
  return network.empty() ? joinSession(session, role) : joinNetworkSession(session, role, network);
}

}  // namespace vps::scenes
