// SPDX-License-Identifier: BSD-3-Clause
// The device node: the haptic part of a run; physics runs at the other end of a link.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

#include "haptics/haptic_driver.h"
#include "haptics/haptic_side.h"
#include "link/link.h"
#include "nodes/device_end.h"
#include "record/scene_archive.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/gains.h"
#include "vps_device/metronome.h"
#include "vps_scenes/network/nodes.h"
#include "world/loop_settings.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::microseconds kRequestPoll{
    200};  // interval of checks for requests; assumed: below a haptic period
constexpr std::chrono::milliseconds kSessionPoll{10};
constexpr std::chrono::milliseconds kUntilSafe{25};  // kPeerLimit_s plus a few ticks
constexpr int kLastStates = 4;  // number of times that the last state is sent; assumed: at least one arrives
constexpr int kPollsPerLook = 25;    // interval of checks whether the render node is alive: 5 ms
constexpr int kPollsPerTimes = 500;  // interval of timing messages: 0.1 s

/// A part's state contains the time of the proxy's state that it answers, and the loop looks this time up by
/// its exact bits. Over a network the time arrives rounded, so the device node stores the exact times that it
/// sent.
class SentTimes {
 public:
  void add(double time_s) noexcept {
    newest_ = (newest_ + 1) % times_s_.size();
    times_s_[newest_] = time_s;
  }
  /// The sent time that rounds to `rounded_s`; `rounded_s` itself if there is no such time.
  [[nodiscard]] double exact_s(double rounded_s) const noexcept {
    constexpr double kRounding_s = 0.6e-6;  // half a microsecond plus rounding of doubles
    for (std::size_t age = 0; age < times_s_.size(); ++age) {
      const double time_s = times_s_[(newest_ + times_s_.size() - age) % times_s_.size()];
      if (std::abs(time_s - rounded_s) < kRounding_s) return time_s;
    }
    return rounded_s;
  }

 private:
  std::array<double, 512> times_s_{};  // as many times as the ticks whose work HapticLoop remembers
  std::size_t newest_ = 0;
};

/// Tells the haptic thread whether the render node is alive. A long physics step does not count as silence.
class SignsOfLife {
 public:
  explicit SignsOfLife(const Link& link) noexcept : link_(link) {}
  [[nodiscard]] bool isSilent() noexcept {
    const std::uint64_t sign = link_.signsOfLife();
    const std::int64_t now_ns = device::monotonicClock().now_ns();
    const std::int64_t looked_ns = std::exchange(looked_ns_, now_ns);
    // After a long gap between calls, the duration of the silence is unknown, so the time starts anew.
    const bool has_slept = now_ns - looked_ns > kLimit_ns;
    if (sign != std::exchange(sign_, sign) || has_slept) changed_ns_ = now_ns;
    return now_ns - changed_ns_ > kLimit_ns;
  }

 private:
  static constexpr auto kLimit_ns = static_cast<std::int64_t>(1e9 * kSilence_s);

  const Link& link_;
  std::uint64_t sign_ = 0;
  std::int64_t changed_ns_ = 0, looked_ns_ = 0;
};

/// The haptic thread's end of the link. The port has its own memory for reading and writing messages.
class RemotePort final : public device::RemotePhysics {
 public:
  RemotePort(Link& link, MessageWriter& writer, const std::atomic<std::uint8_t>*& hand)
      : link_(link), writer_(writer), hand_(hand), buffer_(kLongestMessage) {
    reader_.bindTo(link.sessionId());
  }

  void receive(device::PhysicsState& state) noexcept override {
    const std::string_view bytes = link_.receive(Channel::Physics, buffer_);
    if (bytes.empty()) return;
    const Reading reading = reader_.read(bytes, message_);
    if (isRefused(reading)) refused_.fetch_add(1, std::memory_order_relaxed);
    if (reading != Reading::Good) return;
    state = message_.state;
    state.part.time_s = times_.exact_s(state.part.time_s);
  }
  void send(const device::HapticState& state) noexcept override {
    const std::uint8_t hand = hand_ != nullptr ? hand_->load(std::memory_order_relaxed) : 0;
    times_.add(state.report.time_s);
    link_.send(Channel::Haptic, writer_.write(HapticMessage{state, hand}));
  }
  [[nodiscard]] std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  Link& link_;
  MessageWriter& writer_;
  const std::atomic<std::uint8_t>*& hand_;
  std::vector<char> buffer_;
  MessageReader reader_;
  PhysicsMessage message_;
  SentTimes times_;
  std::atomic<std::uint64_t> refused_{0};
};

/// Sends the haptic thread's log entries, if the render node records.
class LinkLog final : public device::RunLog {
 public:
  LinkLog(Link& link, MessageWriter& writer) : link_(link), writer_(writer) {}
  void setOn(bool is_on) { is_on_.store(is_on, std::memory_order_relaxed); }
  [[nodiscard]] bool isOn() const { return is_on_.load(std::memory_order_relaxed); }
  void add(const device::LogEntry& entry) noexcept override {
    if (!isOn()) return;
    writer_.writeExactStates();
    link_.send(Channel::Log, writer_.write(LogMessage{number_++, entry}));
  }

 private:
  Link& link_;
  MessageWriter& writer_;
  std::atomic<bool> is_on_{false};
  std::uint32_t number_ = 0;
};

/// One session, from joining it until it ends or its render node is lost.
class DeviceSession {
 public:
  DeviceSession(Link& link, const DeviceNodeOptions& options, DeviceNodeResult& result)
      : options_(options),
        result_(result),
        link_(link),
        sender_(newSender()),
        writer_(sender_),
        haptic_writer_(sender_, link.form()),
        buffer_(kLongestMessage),
        scene_(sceneOf(link, options)),
        hand_(makeHand(scene_, true, options.wish)),
        log_(link, haptic_writer_),
        remote_(link, haptic_writer_, hand_state_),
        signs_(link) {
    reader_.bindTo(link.sessionId());
    port_.remote = &remote_;
    const double physics_s = 1 / scene_.fidelity.physics_rate_hz;
    // The scene comes from the render node, so the scene's gains are bounded like gains that the node
    // requests.
    most_gains_ = passiveGains(scene_, hand_->device().limits(), scene_.fidelity.physics_rate_hz);
    device::LoopSettings settings = loopSettings(scene_, hand_->device());
    settings.gains = bounded(settings.gains);
    side_.emplace(
        *hand_, port_, settings,
        HapticTiming{2 * physics_s, physicsLimit_s(physics_s), [this] { return signs_.isSilent(); }}, log_);
    hand_state_ = &side_->stateByte();
  }

  /// Runs the session. Returns true if the session ended regularly or the user stops, false if the render
  /// node was lost.
  bool run() {
    for (int polls = 1;; ++polls) {
      if (!has_request_ && polls % kPollsPerTimes == 1) sayHello();
      takeRequests();
      if (polls % kPollsPerTimes == 0) {
        sendTimes();
        for (const std::string& words : doubts_.takeNew(link_)) say(words);
      }
      if (options_.stop != nullptr && options_.stop->load()) return finish(true);
      if (polls % kPollsPerLook == 0) {
        if (link_.hasEnded()) return finish(true);
        if (!link_.isAlive(NodeRole::Render)) {
          // The loop itself detects that the part's state is too old, and shows the fault to watchers.
          std::this_thread::sleep_for(kUntilSafe);
          return finish(link_.hasEnded());
        }
      }
      std::this_thread::sleep_for(kRequestPoll);
    }
  }
  [[nodiscard]] std::string deviceName() const { return std::string(hand_->device().name()); }

 private:
  static Scene sceneOf(const Link& link, const DeviceNodeOptions& options) {
    Scene scene = sceneFromBytes(link.sceneBytes(), sessionWords(options.session));
    if (!options.kind.empty()) scene.device.kind = options.kind;
    return scene;
  }
  void sayHello() {
    HelloMessage hello;
    hello.limits = hand_->device().limits();
    const std::string_view name = hand_->device().name();
    std::memcpy(hello.name.data(), name.data(), std::min(name.size(), hello.name.size() - 1));
    const device::DeviceKind* kind = device::findDeviceKind(scene_.device.kind);
    hello.is_by_person = kind != nullptr && !kind->isSimulated();
    hello.may_rearm = options_.rearms || !hello.is_by_person;
    link_.send(Channel::Reply, writer_.write(hello));
  }
  void sendTimes() {
    const RealTimeResult timing = side_->realTime();
    TimesMessage times;
    times.tick = side_->times();
    times.late = timing.late;
    times.response = timing.response;
    for (std::size_t i = 0; i < times.missed_by.size(); ++i) times.missed_by[i] = timing.missed_by[i].second;
    times.stale_ticks = timing.stale_ticks;
    times.worst_tick = timing.worst_tick;
    times.worst_us = timing.worst_us;
    times.faults = timing.faults;
    for (int i = 0; i < device::kTickCauses; ++i)
      if (timing.worst_cause == toText(static_cast<device::TickCause>(i)))
        times.worst_cause = static_cast<std::uint8_t>(i);
    times.has_priority = timing.has_priority;
    times.has_locked_memory = timing.has_locked_memory;
    link_.send(Channel::Reply, writer_.write(times));
  }
  void takeRequests() {
    for (std::string_view bytes; !(bytes = link_.receive(Channel::Request, buffer_)).empty();) {
      RequestMessage request;
      const Reading reading = reader_.read(bytes, request);
      if (reading == Reading::Replayed)
        link_.send(Channel::Reply, writer_.write(reply_));  // the first reply was lost
      if (reading != Reading::Good) continue;
      has_request_ = true;
      const std::string refusal = carryOut(request);
      if (!refusal.empty() && result_.refused_requests++ == 0) say(refusal);
      const std::uint8_t hand = device::toByte(side_->state());
      reply_ = {reader_.envelope().number, hand, side_->tick(), {}};
      std::memcpy(reply_.refusal.data(), refusal.data(), std::min(refusal.size(), reply_.refusal.size() - 1));
      link_.send(Channel::Reply, writer_.write(reply_));
    }
  }
  /// Carries out a request. Returns the reason of a refusal; empty: done.
  std::string carryOut(const RequestMessage& request) {
    switch (request.kind) {
      case RequestKind::Start:
        side_->start();
        return {};
      case RequestKind::Stop:
        side_->stop();
        // The last state belongs to the recording, and states may be lost on their way, so it is sent several
        // times.
        for (int i = 0; log_.isOn() && i < kLastStates; ++i) remote_.send(side_->loopState());
        sendTimes();
        return {};
      case RequestKind::Setup:
        log_.setOn(request.keeps_log);
        side_->setGains(bounded(request.gains));
        return {};
      case RequestKind::Command:
        break;
    }
    const bool begins = request.command == device::SyncEventKind::Begin;
    // GoBack may also name the step after the last one.
    if (request.step >= scene_.steps.size() + (begins ? 0 : 1))
      return "the render node requests step " + std::to_string(request.step + std::uint64_t{1}) +
             ", but the scene has " + std::to_string(scene_.steps.size()) + " steps; the request was ignored";
    HandCommand command{request.command, request.X_WG, request.step, request.now_s, request.task};
    if (begins) {
      const std::vector<Pose>& all = scene_.steps[request.step].way_points;
      const std::size_t ahead = std::min<std::size_t>(request.way_points_left, all.size());
      command.task.way_points.assign(all.end() - static_cast<std::ptrdiff_t>(ahead), all.end());
    }
    side_->carryOut(command);
    return {};
  }
  /// Limits the gains that another node requests to those at which the device is passive; reports the first
  /// limitation.
  CouplingGains bounded(const CouplingGains& wish) {
    const CouplingGains gains = device::softerOf(wish, most_gains_);
    const bool is_bounded = gains.k_N_per_m < wish.k_N_per_m || gains.b_Ns_per_m < wish.b_Ns_per_m ||
                            gains.k_Nm_per_rad < wish.k_Nm_per_rad ||
                            gains.b_Nms_per_rad < wish.b_Nms_per_rad;
    if (is_bounded && !std::exchange(has_said_bound_, true)) {
      char words[200];
      std::snprintf(words, sizeof words,
                    "the render node requests a coupling of %.0f N/m and %.1f N m/rad; this device is only "
                    "passive up to "
                    "%.0f and %.1f, which are used instead",
                    wish.k_N_per_m, wish.k_Nm_per_rad, most_gains_.k_N_per_m, most_gains_.k_Nm_per_rad);
      say(words);
    }
    return gains;
  }
  void say(const std::string& words) const {
    if (options_.say) options_.say(words);
  }
  bool finish(bool has_ended) {
    side_->stop();
    sendTimes();
    const TickTimes times = side_->times();
    result_.ticks += times.count;
    result_.missed += times.missed;
    result_.faults += side_->realTime().faults;
    // A repeated request was answered again and does not count as refused.
    const std::uint64_t repeated = reader_.counts()[static_cast<std::size_t>(Reading::Replayed)];
    result_.refused += remote_.refused() + reader_.refused() - repeated + link_.refusedBeats();
    if (const std::string doubts = ClockDoubts::summary(link_); !doubts.empty()) say(doubts);
    return has_ended;
  }

  const DeviceNodeOptions& options_;
  DeviceNodeResult& result_;
  Link& link_;
  std::uint64_t sender_;
  MessageWriter writer_;         ///< writer of this thread
  MessageWriter haptic_writer_;  ///< writer of the haptic thread, for other kinds of messages
  MessageReader reader_;
  ReplyMessage reply_;  ///< the last reply
  ClockDoubts doubts_;
  CouplingGains most_gains_;
  bool has_said_bound_ = false;
  bool has_request_ = false;
  std::vector<char> buffer_;
  Scene scene_;
  std::unique_ptr<Hand> hand_;
  LinkLog log_;
  const std::atomic<std::uint8_t>* hand_state_ = nullptr;
  RemotePort remote_;
  SignsOfLife signs_;
  device::CouplingPort port_;
  std::optional<HapticSide> side_;
};

}  // namespace

DeviceNodeResult deviceNode(const DeviceNodeOptions& options) {
  requireSessionName(options.session);
  const auto say = [&options](const std::string& words) {
    if (options.say) options.say(words);
  };
  DeviceNodeResult result;
  bool has_said = false;
  while (options.stop == nullptr || !options.stop->load()) {
    const std::unique_ptr<Link> link = joinSession(options.session, NodeRole::Device, options.network);
    if (link == nullptr) {
      if (!has_said) say("waiting for " + sessionWords(options.session) + ", which vps render starts");
      has_said = true;
      std::this_thread::sleep_for(kSessionPoll);
      continue;
    }
    has_said = false;
    ++result.sessions;
    if (options.before_hello) options.before_hello();
    DeviceSession session(*link, options, result);
    say("the device '" + session.deviceName() + "' joins " + sessionWords(options.session));
    if (!session.run()) {
      ++result.lost;
      say("the render node was lost; the force is zero until it is back");
      continue;
    }
    if (!options.stays) break;
  }
  return result;
}

}  // namespace vps::scenes
