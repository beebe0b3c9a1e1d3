// SPDX-License-Identifier: BSD-3-Clause
// The link over UDP. The threads of a node use rings in their own process, as in shared memory; a thread of
// the link passes the messages to DDS, and threads of DDS fill the incoming rings. Thus no haptic thread
// calls DDS, which locks and allocates. The physics thread writes its states to DDS directly.
#include <semaphore.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "dds/topics.h"
#include "link/clock_estimate.h"
#include "link/link.h"
#include "messages/messages.h"
#include "vps/errors.h"
#include "vps_device/detail/bytes.h"
#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"

namespace vps::scenes {

namespace {

constexpr std::int64_t kBeat_ns = 20'000'000;
constexpr auto kSign_ns = static_cast<std::int64_t>(1e9 * kSignPeriod_s);
constexpr double kAlive_s = 0.1;  ///< a node without a beat for this time counts as lost
constexpr double kFind_s = 1;     ///< time limit to find a session
/// Time limit to hear another node. Assumed: DDS finds a neighbour within a tenth of a second.
constexpr double kListen_s = 0.5;
constexpr std::size_t kDenseChannels = 2;  ///< Haptic and Physics, whose states have two forms
constexpr std::size_t kTrips = 64;
constexpr std::size_t kSceneHead = 16;

std::int64_t now_ns() {
  return device::monotonicClock().now_ns();
}
double since_s(std::int64_t ns) {
  return 1e-9 * static_cast<double>(now_ns() - ns);
}

/// Waits for the semaphore, at most `most_ns`. Uses the monotonic clock, so that setting the system clock
/// delays no beat.
void waitUntil(sem_t& semaphore, std::int64_t most_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  timespec until{};
  clock_gettime(CLOCK_MONOTONIC, &until);
  const std::int64_t ns = until.tv_nsec + most_ns;
  until.tv_sec += ns / kSecond_ns;
  until.tv_nsec = ns % kSecond_ns;
  sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until);
}

Delivery deliveryOf(Channel channel) {
  return isState(channel) ? Delivery::Newest : Delivery::Reliable;
}
const char* nameOf(Channel channel) {
  constexpr std::array<const char*, kChannels> kNames = {"haptic", "physics", "snapshot", "request",
                                                         "reply",  "log",     "news"};
  return kNames[static_cast<std::size_t>(channel)];
}

/// State of another node.
struct Peer {
  NodeRole role = NodeRole::Watch;
  std::uint64_t session = 0;
  bool has_ended = false;
  std::int64_t sent_ns = 0;   ///< sending time of the peer's last beat, by the peer's clock
  std::int64_t heard_ns = 0;  ///< arrival time of the peer's last beat, by our clock
  MessageOrder order;         ///< order of the peer's beats
  ClockEstimate clock;
  std::vector<double> trips_s;  ///< the last round trips
  std::size_t next_trip = 0;
};

class DdsLink final : public Link {
 public:
  DdsLink(const std::string& session, NodeRole role, const SessionNetwork& network)
      : role_(role), writer_(newSender()), participant_(network) {
    sem_init(&wake_, 0, 0);
    sem_init(&arrived_, 0, 0);
    beats_in_.emplace(participant_, topicName(session, "beat"), Delivery::Newest,
                      [this](std::string_view bytes) { takeBeat(bytes); });
    beats_out_.emplace(participant_, topicName(session, "beat"), Delivery::Newest, nullptr);
    for (std::size_t i = 0; i < kChannels; ++i) addChannel(static_cast<Channel>(i), session);
    if (role != NodeRole::Render)
      scene_.emplace(participant_, topicName(session, "scene"), Delivery::Kept,
                     [this](std::string_view bytes) {
                       const std::lock_guard lock(mutex_);
                       scenes_[device::ByteReader(bytes).get<std::uint64_t>()] = bytes;
                     });
    else
      scene_.emplace(participant_, topicName(session, "scene"), Delivery::Kept, nullptr);
  }
  ~DdsLink() override {
    if (pump_.joinable()) {
      is_ending_ = true;
      sem_post(&wake_);
      pump_.join();
    }
    beats_in_.reset();  // from here on no thread of DDS calls this object
    scene_.reset();
    for (std::optional<DdsTopic>& topic : topics_) topic.reset();
    for (std::optional<DdsTopic>& topic : dense_topics_) topic.reset();
    sem_destroy(&wake_);
    sem_destroy(&arrived_);
  }

  /// Opens a new session.
  void open(std::string_view scene_bytes) {
    session_ = writer_.sender();
    std::string bytes;
    device::ByteWriter w(bytes);
    w.put(session_.load());
    w.put(std::uint64_t{kMessageVersion});
    w.bytes(scene_bytes);
    scene_->write(bytes);
  }
  void start() {
    pump_ = std::thread([this] { pump(); });
  }
  /// Waits for a render node. Returns false if there is no render node, or if its scene has not arrived.
  bool find() {
    return waitFor(kFind_s, [this] {
      const std::lock_guard lock(mutex_);
      for (const auto& [sender, peer] : peers_)
        if (peer.role == NodeRole::Render && !peer.has_ended && scenes_.contains(peer.session))
          session_ = peer.session;
      return session_ != 0;
    });
  }

  /// Whether the session has a node of this role, which sends its role in each beat; waits up to kListen_s.
  [[nodiscard]] bool hears(NodeRole role) const {
    return waitFor(kListen_s, [&] { return isAlive(role); });
  }

  [[nodiscard]] WireForm form() const noexcept override { return WireForm::Compact; }
  bool send(Channel channel, std::string_view message) noexcept override {
    // The physics thread may call DDS; writing directly saves the detour over the link's thread.
    if (channel == Channel::Physics && role_ == NodeRole::Render) {
      stated_ns_.store(now_ns(), std::memory_order_relaxed);
      return write(channel, message);
    }
    const bool is_sent = writers_[static_cast<std::size_t>(channel)].write(message);
    sem_post(&wake_);  // never blocks
    return is_sent;
  }
  std::string_view receive(Channel channel, std::span<char> buffer) noexcept override {
    RingReader& reader = readers_[static_cast<std::size_t>(channel)];
    return isState(channel) ? reader.latest(buffer) : reader.next(buffer);
  }
  [[nodiscard]] std::uint64_t lost(Channel channel) const noexcept override {
    return readers_[static_cast<std::size_t>(channel)].lost();
  }
  void waitForMessage(std::int64_t most_ns) const override { waitUntil(arrived_, most_ns); }
  [[nodiscard]] std::uint64_t signsOfLife() const noexcept override {
    return signs_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool isAlive(NodeRole role) const override { return aliveOf(role) > 0; }
  [[nodiscard]] std::size_t watchers() const override { return aliveOf(NodeRole::Watch); }
  [[nodiscard]] std::uint64_t sessionId() const override { return session_; }
  [[nodiscard]] bool hasEnded() const override {
    const std::lock_guard lock(mutex_);
    return std::any_of(peers_.begin(), peers_.end(), [&](const auto& entry) {
      return entry.second.role == NodeRole::Render && entry.second.session == session_ &&
             entry.second.has_ended;
    });
  }
  [[nodiscard]] std::optional<PeerTiming> timing(NodeRole role) const override;
  [[nodiscard]] std::vector<PeerDoubt> doubts() const override {
    const std::lock_guard lock(mutex_);
    std::vector<PeerDoubt> doubts;
    for (const auto& [sender, peer] : peers_)
      if (peer.session == session_ && peer.clock.contradictions() > 0)
        doubts.push_back({peer.role, sender, peer.clock.contradictions()});
    return doubts;
  }
  [[nodiscard]] std::uint64_t refusedBeats() const override { return refused_beats_; }
  [[nodiscard]] std::string sceneBytes() const override {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(session_);
    if (found == scenes_.end() || found->second.size() < kSceneHead) return {};
    return found->second.substr(kSceneHead);
  }
  [[nodiscard]] bool isSameVersion() const {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(session_);
    if (found == scenes_.end() || found->second.size() < kSceneHead) return false;
    return device::ByteReader(std::string_view(found->second).substr(8)).get<std::uint64_t>() ==
           kMessageVersion;
  }

 private:
  /// Number of live nodes with this role in the session.
  [[nodiscard]] std::size_t aliveOf(NodeRole role) const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(peers_.begin(), peers_.end(), [&](const auto& entry) {
      const Peer& peer = entry.second;
      return peer.role == role && peer.session == session_ && !peer.has_ended &&
             since_s(peer.heard_ns) < kAlive_s;
    }));
  }
  /// Waits until the condition holds, at most `most_s`.
  template <typename IsSo>
  static bool waitFor(double most_s, IsSo is_so) {
    for (const std::int64_t begun_ns = now_ns(); since_s(begun_ns) < most_s;) {
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  void addChannel(Channel channel, const std::string& session) {
    const auto i = static_cast<std::size_t>(channel);
    rings_[i] = std::make_unique<SharedWord[]>(kChannelShapes[i].words());
    SharedWord* ring = rings_[i].get();
    writers_[i] = RingWriter(ring, kChannelShapes[i]);
    readers_[i] = RingReader(ring, kChannelShapes[i]);
    const bool is_out = writerOf(channel) == role_;
    if (!is_out && !isReader(channel, role_)) return;
    std::function<void(std::string_view)> receive;
    if (!is_out)
      receive = [this, i](std::string_view bytes) {
        {
          const std::lock_guard lock(
              receive_mutex_);  // a channel has two topics, whose threads write one ring
          writers_[i].write(bytes);
        }
        int waiting = 0;
        if (sem_getvalue(&arrived_, &waiting) == 0 && waiting <= 0) sem_post(&arrived_);
        if (writerOf(static_cast<Channel>(i)) == NodeRole::Render)
          signs_.fetch_add(1, std::memory_order_relaxed);
      };
    if (i < kDenseChannels)
      dense_topics_[i].emplace(participant_, topicName(session, nameOf(channel) + std::string("_state")),
                               deliveryOf(channel), receive, TopicType::State);
    topics_[i].emplace(participant_, topicName(session, nameOf(channel)), deliveryOf(channel),
                       std::move(receive));
  }
  void pump();
  void passOn();
  bool write(Channel channel, std::string_view message) {
    const auto i = static_cast<std::size_t>(channel);
    (i < kDenseChannels && isDense(message) ? dense_topics_ : topics_)[i]->write(message);
    return true;
  }
  void sendBeats();
  void takeBeat(std::string_view bytes);

  NodeRole role_;
  MessageWriter writer_;  ///< writer of beats
  DdsParticipant participant_;
  std::array<std::unique_ptr<SharedWord[]>, kChannels> rings_;
  std::array<RingWriter, kChannels> writers_;
  std::array<RingReader, kChannels> readers_;
  std::atomic<std::uint64_t> session_{0};
  mutable std::mutex mutex_;  ///< guards the members below; no haptic thread locks it
  std::map<std::uint64_t, Peer> peers_;
  std::map<std::uint64_t, std::string> scenes_;
  std::vector<char> buffer_ = std::vector<char>(kLongestMessage);
  sem_t wake_{};
  mutable sem_t arrived_{};                 ///< 0 or 1; 1: a message has arrived since the last wait
  std::atomic<std::uint64_t> signs_{0};     ///< counts messages of the render node
  std::atomic<std::int64_t> stated_ns_{0};  ///< time of physics' last state
  std::atomic<bool> is_ending_{false};
  std::atomic<std::uint64_t> refused_beats_{0};
  std::mutex receive_mutex_;
  // The topics are declared after all members that threads of DDS use.
  std::array<std::optional<DdsTopic>, kChannels> topics_, dense_topics_;
  std::optional<DdsTopic> beats_in_, beats_out_, scene_;
  std::thread pump_;
};

std::optional<PeerTiming> DdsLink::timing(NodeRole role) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [sender, peer] : peers_) {
    if (peer.role != role || peer.session != session_ || peer.trips_s.size() < kTrips / 4) continue;
    return PeerTiming{*std::max_element(peer.trips_s.begin(), peer.trips_s.end()),
                      peer.clock.offset_s(now_ns()), peer.clock.error_s(), peer.clock.drift(),
                      peer.clock.contradictions()};
  }
  return {};
}

void DdsLink::pump() {
  device::requestRealTime(kLinkPriority, false);
  std::int64_t next_beat_ns = now_ns();
  while (!is_ending_) {
    passOn();
    // The device node has to see that this node is alive during a long physics step.
    const bool is_silent =
        role_ == NodeRole::Render && now_ns() - stated_ns_ >= kSign_ns && isAlive(NodeRole::Device);
    if (now_ns() >= next_beat_ns || is_silent) {
      sendBeats();
      next_beat_ns = now_ns() + kBeat_ns;
    }
    waitUntil(wake_, role_ == NodeRole::Render ? kSign_ns : kBeat_ns);
    while (sem_trywait(&wake_) == 0) {
    }
  }
  passOn();
  for (int i = 0; i < 3; ++i) sendBeats();  // beats may be lost, so several are sent
}

void DdsLink::passOn() {
  for (std::size_t i = 0; i < kChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    if (writerOf(channel) != role_) continue;
    while (true) {
      const std::string_view bytes = receive(channel, buffer_);
      if (bytes.empty()) break;
      write(channel, bytes);
    }
  }
}

void DdsLink::sendBeats() {
  std::vector<BeatMessage> beats;
  {
    const std::lock_guard lock(mutex_);
    BeatMessage beat{role_, session_, is_ending_ && role_ == NodeRole::Render, 0, 0, 0};
    for (auto& [sender, peer] : peers_) {
      if (since_s(peer.heard_ns) > kAlive_s || peer.sent_ns == 0) continue;
      beat.peer = sender;
      beat.peer_sent_ns = peer.sent_ns;
      beat.received_ns = peer.heard_ns;
      beats.push_back(beat);
    }
    if (beats.empty()) beats.push_back(beat);
  }
  for (const BeatMessage& beat : beats) beats_out_->write(writer_.write(beat));
}

void DdsLink::takeBeat(std::string_view bytes) {
  const std::int64_t heard_ns = now_ns();
  MessageReader reader;
  BeatMessage beat;
  if (reader.read(bytes, beat) != Reading::Good) {
    ++refused_beats_;
    return;
  }
  const Envelope& envelope = reader.envelope();
  if (envelope.sender == writer_.sender()) return;  // a beat of this node
  const std::lock_guard lock(mutex_);
  constexpr std::size_t kMostPeers = 64;  // limits the memory that a flood of senders can take
  if (!peers_.contains(envelope.sender) && peers_.size() >= kMostPeers)
    std::erase_if(peers_, [](const auto& entry) { return since_s(entry.second.heard_ns) > kAlive_s; });
  if (!peers_.contains(envelope.sender) && peers_.size() >= kMostPeers) return;
  Peer& peer = peers_[envelope.sender];
  if (peer.order.place(envelope.number, envelope.time_ns, heard_ns) != MessageOrder::Place::Next) {
    ++refused_beats_;
    return;
  }
  peer.role = beat.role;
  peer.session = beat.session;
  peer.has_ended = peer.has_ended || beat.has_ended;
  peer.sent_ns = envelope.time_ns;
  peer.heard_ns = heard_ns;
  if (beat.role == NodeRole::Render && beat.session == session_)
    signs_.fetch_add(1, std::memory_order_relaxed);
  if (beat.peer != writer_.sender()) return;
  const ClockExchange exchange{beat.peer_sent_ns, beat.received_ns, envelope.time_ns, heard_ns};
  peer.clock.add(exchange);
  if (peer.trips_s.size() < kTrips)
    peer.trips_s.push_back(exchange.roundTrip_s());
  else
    peer.trips_s[peer.next_trip++ % kTrips] = exchange.roundTrip_s();
}

}  // namespace

std::unique_ptr<Link> makeNetworkSession(const std::string& session, std::string_view scene_bytes,
                                         const SessionNetwork& network) {
  requireSessionName(session);
  {
    DdsLink other(session, NodeRole::Watch, network);
    other.start();
    if (other.find() && other.isAlive(NodeRole::Render))
      throw LoadError(
          "", "",
          sessionWords(session) + ": another vps render already runs this session; choose another --session");
  }
  auto link = std::make_unique<DdsLink>(session, NodeRole::Render, network);
  link->open(scene_bytes);
  link->start();
  return link;
}

std::unique_ptr<Link> joinNetworkSession(const std::string& session, NodeRole role,
                                         const SessionNetwork& network) {
  requireSessionName(session);
  auto link = std::make_unique<DdsLink>(session, role, network);
  link->start();
  if (!link->find()) return nullptr;
  if (!link->isSameVersion())
    throw LoadError("", "",
                    sessionWords(session) +
                        " is run by another version of vps render; use the same version for all nodes");
  if (role == NodeRole::Device && link->hears(NodeRole::Device))
    throw LoadError("", "", sessionWords(session) + " has a device already; only one hand can hold the part");
  return link;
}

}  // namespace vps::scenes
