// SPDX-License-Identifier: BSD-3-Clause
// A run whose haptic loop is in the device node. Physics runs in real time, as with makeRealTimeDriver().
//
// If the device is lost, physics stops, so that the part stays where it is. When the device is back, or a new
// process with the same device has joined, the device is moved to its last position, and physics continues.
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <thread>
#include <utility>

#include "haptics/clocked_driver.h"
#include "haptics/merged_log.h"
#include "nodes/device_end.h"
#include "simulation/physics_clock.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

/// A live device that is silent for longer than this time also stops physics [s]. Assumed: longer than any
/// scheduling delay; the proxy stands still during the silence.
constexpr double kHiccup_s = 0.1;
constexpr double kLastLog_s =
    2;  ///< time limit for the last log entries; assumed: DDS repeats a message within a tenth of a second
constexpr std::uint64_t kAdvancesPerDoubt =
    256;  // interval of checks for inconsistent clocks; assumed: a few times per second
/// Number of good physics steps before the loop is re-armed, if the device node allows re-arming.
constexpr int kStepsUntilRearm = 50;

/// Number of way points still ahead of a part at p_W: those after the leg nearest to it.
std::size_t wayPointsAhead(const SceneStep& step, const Vec3& p_W) {
  const std::size_t count = step.way_points.size();
  double nearest_m = std::numeric_limits<double>::infinity();
  std::size_t ahead = count;
  for (std::size_t leg = 0; leg <= count; ++leg) {
    const Vec3 from_W = leg == 0 ? step.X_WP_start.p : step.way_points[leg - 1].p;
    const Vec3 way_W = (leg == count ? step.X_WP_target.p : step.way_points[leg].p) - from_W;
    const double length2 = way_W.squaredNorm();
    const double share = length2 > 0 ? std::clamp((p_W - from_W).dot(way_W) / length2, 0.0, 1.0) : 0;
    const double distance_m = (p_W - from_W - share * way_W).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    ahead = count - leg;
  }
  return ahead;
}

bool isOver(device::OperatorPhase phase) {
  return phase == device::OperatorPhase::Done || phase == device::OperatorPhase::Failed;
}

class RemoteDriver final : public ClockedDriver {
 public:
  RemoteDriver(DeviceEnd& end, const Scene& scene, const device::LoopSettings& settings, double physics_s,
               const ReportFault& report, MergedLog* log)
      : ClockedDriver(settings, report),
        end_(end),
        scene_(scene),
        log_(log),
        gains_(settings.gains),
        clock_(physics_s),
        joins_(end.joins()) {
    askUntilDone(setup());
  }
  ~RemoteDriver() override { pause(); }

  void pause() override {
    is_wanted_ = false;
    if (is_running_ && ask({.kind = RequestKind::Stop})) {
      takeLastLog();
      takeStateSinceRequest(log_ != nullptr ? kLastLog_s : 0);
      if (log_ != nullptr && newest_.tick < end_.reply().tick) log_->lose(1);
      setView(newest_);
    }
    is_running_ = false;
    clock_.stop();
  }
  void resume() override {
    rearmIfFaulted();
    if (is_running_) return;
    is_wanted_ = true;
    askUntilDone({.kind = RequestKind::Start});
    is_running_ = true;
    has_priority_ = clock_.start(false).has_priority;
  }

  bool advance() override {
    clock_.wait();
    end_.poll();
    takeStateSinceRequest();
    if (!keepDevice()) return false;
    if (++advances_ % kAdvancesPerDoubt == 0) end_.sayDoubts();
    rearmWhenGood();
    takeStateSinceRequest();
    takeLog();
    if (log_ != nullptr) log_->waitForTick(newest_.tick);
    logEvent(newest_, device::SyncEventKind::Step);
    // The view is set after the step's log entry, because it reports faults, which a replay also logs after
    // the step.
    setView(newest_);
    return true;
  }
  bool hasSettled(bool is_ready) override {
    if (is_ready) logEvent(view_, device::SyncEventKind::Settled);
    return is_ready;
  }
  bool givesUp(bool is_wanted) override {
    if (is_wanted) logEvent(view_, device::SyncEventKind::GiveUp);
    return is_wanted;
  }
  void setGains(const CouplingGains& gains) override {
    settings_.gains = gains_ = gains;
    askUntilDone(setup());
  }
  device::OperatorState state() override { return known_state_; }
  std::uint64_t missed() override { return end_.times().tick.missed; }
  [[nodiscard]] double busy_s() const override { return clock_.busy_s(); }
  void setLoadLevel(double step_s, double period_s, const CouplingGains& gains) override {
    clock_.setLoadLevel(step_s, period_s);
    gains_ = gains;
    askUntilDone(setup());
  }
  TickTimes times() override { return end_.times().tick; }
  std::optional<RealTimeResult> realTime() override;

 protected:
  void command(const HandCommand& command) override {
    keep(command);
    RequestMessage request;
    request.command = command.what;
    request.X_WG = command.X_WG;
    request.step = static_cast<std::uint32_t>(command.step);
    request.now_s = command.now_s;
    request.task = command.task;
    request.way_points_left = static_cast<std::uint32_t>(command.task.way_points.size());
    askUntilDone(request);
    takeLog();
    if (log_ != nullptr) log_->waitForEvent(command.what);
  }
  void store(const device::PhysicsState& state) override {
    part_ = state;
    end_.send(state);
  }

 private:
  /// The setup request; a recording ends once the device was lost.
  [[nodiscard]] RequestMessage setup() const {
    return {.kind = RequestKind::Setup, .keeps_log = log_ != nullptr && interruptions_ == 0, .gains = gains_};
  }
  /// Stores the commands that have to be repeated for a device that joins later.
  void keep(const HandCommand& command);
  /// Sends a request. Returns false if the device was lost in the meantime.
  bool ask(const RequestMessage& request) {
    if (!end_.request(request, [this] { showThatPhysicsLives(); })) return false;
    known_state_ = device::stateFromByte(end_.reply().hand);
    return true;
  }
  /// Sends a state with a new time and zero velocity while a request is pending and physics stands still, so
  /// that the loop does not treat the part as stalled. Not used in a recorded run, since a replay only has
  /// states of steps.
  void showThatPhysicsLives();
  /// Sends a request; if the device is lost before the request was carried out, restores the device when the
  /// device is back.
  void askUntilDone(const RequestMessage& request) {
    if (!ask(request) && !end_.isStopped()) waitAndRestore();
  }
  /// Handles a lost device by waiting for it. Returns false if the run was stopped.
  bool keepDevice();
  bool waitAndRestore();
  /// Brings a new device process to the state that the lost process had in `phase`. Returns false if the new
  /// process was lost, too.
  bool restore(device::OperatorPhase phase);
  bool restoreHold(device::OperatorPhase phase);
  void rearmWhenGood();
  /// Takes the newest state. A state that was sent before the last request was carried out is ignored, since
  /// it shows the phase of the hand before the request, such as Done of the previous step.
  void takeState() {
    const HapticMessage* message = end_.takeState();
    if (message == nullptr || message->state.tick < end_.reply().tick) return;
    if (message->state.tick > end_.reply().tick) known_state_ = device::stateFromByte(message->hand);
    newest_ = message->state;
  }
  /// Waits for a state that is newer than the last reply; over UDP a reply may overtake earlier states.
  void takeStateSinceRequest(double most_s = kPeerLimit_s) {
    takeState();
    for (double left_s = most_s; left_s > 0 && is_running_ && newest_.tick < end_.reply().tick;
         left_s -= 1e-4) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      takeState();
    }
  }
  void takeLog() {
    end_.takeLog([this](std::uint32_t number, const device::LogEntry& entry) {
      if (log_ != nullptr) log_->addFromLoop(number, entry);
    });
  }
  /// Takes the remaining log entries of a stopped loop. Entries that do not arrive within kLastLog_s are
  /// lost.
  void takeLastLog() {
    if (log_ == nullptr) return;
    log_->waitForEvent(device::SyncEventKind::Paused);
    for (double left_s = kLastLog_s; left_s > 0; left_s -= 1e-3) {
      takeLog();
      if (!log_->isWaiting()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    log_->lose(1);
  }
  void logEvent(const device::HapticState& state, device::SyncEventKind kind) {
    if (log_ != nullptr) log_->add(device::SyncEvent{state.report.time_s, state.tick, 1, 0, kind});
  }

  DeviceEnd& end_;
  const Scene& scene_;
  MergedLog* log_;                     ///< null: the run is not recorded
  device::OperatorState known_state_;  ///< state of the hand as of the last advance() or command
  device::HapticState newest_;         ///< newest state of the loop; advance() copies it to view_
  device::PhysicsState part_;          ///< last state sent
  CouplingGains gains_;
  std::optional<HandCommand> begun_;  ///< command on which the hand is working
  Pose X_WG_;                         ///< pose of the grasp of the part that the hand holds
  bool is_holding_ = false, is_clutch_open_ = false;
  bool is_running_ = false, is_wanted_ = false, has_priority_ = false;
  int good_steps_ = 0;  ///< number of good physics steps since the last fault
  PhysicsClock clock_;
  int joins_;
  std::uint64_t interruptions_ = 0, advances_ = 0;
};

void RemoteDriver::showThatPhysicsLives() {
  if (!is_running_ || !part_.part.is_coupled || log_ != nullptr) return;
  const HapticMessage* message = end_.takeState();
  if (message == nullptr) return;
  device::PhysicsState state = part_;
  state.part.time_s = message->state.report.time_s;
  state.part.V_W = state.held.V_WP = {};
  state.stored_J.reset();
  end_.send(state);
}

void RemoteDriver::keep(const HandCommand& command) {
  switch (command.what) {
    case device::SyncEventKind::HandOver:
      is_holding_ = true;
      is_clutch_open_ = false;
      X_WG_ = command.X_WG;
      part_.part.is_coupled = false;  // the last state belonged to another part
      return;
    case device::SyncEventKind::LetGo:
      is_holding_ = false;
      begun_.reset();
      return;
    case device::SyncEventKind::OpenClutch:
      is_clutch_open_ = true;
      return;
    case device::SyncEventKind::CloseClutch:
      is_clutch_open_ = false;
      return;
    case device::SyncEventKind::Begin:
      begun_ = command;
      return;
    default:
      return;
  }
}

bool RemoteDriver::keepDevice() {
  if (end_.joins() == joins_) {
    const double silence_s = end_.silence_s();
    const bool is_lost = silence_s > kHiccup_s || (silence_s > kPeerLimit_s && !end_.isPresent());
    if (!is_running_ || !is_lost) return true;
  }
  end_.say("the device does not respond; physics waits for it");
  return waitAndRestore();
}

bool RemoteDriver::waitAndRestore() {
  const device::OperatorPhase phase = known_state_.phase;
  ++interruptions_;
  if (log_ != nullptr) log_->lose(1);  // a recording ends here, since the lost device's actions are unknown
  for (;;) {
    while (!end_.isPresent() || end_.silence_s() > kPeerLimit_s) {
      if (end_.isStopped()) return false;
      end_.poll();
      if (end_.joins() != joins_) break;
      if (end_.isPresent() && end_.takeState() != nullptr) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (end_.joins() == joins_) break;  // the same process responds again
    joins_ = end_.joins();
    if (restore(phase)) break;
    if (end_.isStopped()) return false;
  }
  end_.say("the device is back; physics continues");
  if (is_running_) clock_.start(false);
  good_steps_ = 0;
  return true;
}

bool RemoteDriver::restore(device::OperatorPhase phase) {
  end_.send(part_);
  if (!ask(setup())) return false;
  if (!is_wanted_) return true;
  if (!ask({.kind = RequestKind::Start})) return false;
  return !is_holding_ || restoreHold(phase);
}

bool RemoteDriver::restoreHold(device::OperatorPhase phase) {
  const std::size_t index = begun_ ? begun_->step : 0;
  // The empty hand moves to the start of the step, and takes the part from there.
  RequestMessage request{.command = device::SyncEventKind::GoBack};
  request.step = static_cast<std::uint32_t>(index);
  if (!ask(request)) return false;
  for (double left_s = kHandReturn_s; left_s > 0 && !end_.isStopped(); left_s -= 0.01)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  request = {.command = device::SyncEventKind::HandOver};
  request.X_WG = part_.part.is_coupled ? part_.part.X_W : X_WG_;
  if (!ask(request)) return false;
  if (begun_ && !isOver(phase)) {
    const SceneStep& step = scene_.steps[index];
    request = {.command = device::SyncEventKind::Begin};
    request.step = static_cast<std::uint32_t>(index);
    request.now_s = begun_->now_s;
    request.task = begun_->task;
    if (part_.part.is_coupled) {
      request.task.X_WP_start = part_.held.X_WP;
      request.way_points_left = static_cast<std::uint32_t>(wayPointsAhead(step, part_.held.X_WP.p));
    }
    if (!ask(request)) return false;
  }
  return !is_clutch_open_ || ask({.command = device::SyncEventKind::OpenClutch});
}

// Re-arms as a person would; the force then returns gradually, starting with a new grasp of the part at its
// pose.
void RemoteDriver::rearmWhenGood() {
  end_.setFaulted(newest_.safety.fault != device::SafetyFault::None);
  if (is_running_ && end_.takeRearm() && end_.hello().may_rearm) return rearmIfFaulted();
  const bool waits =
      is_running_ && end_.hello().may_rearm && newest_.safety.fault == device::SafetyFault::PhysicsStalled;
  good_steps_ = waits ? good_steps_ + 1 : 0;
  if (good_steps_ < kStepsUntilRearm) return;
  good_steps_ = 0;
  rearmIfFaulted();
}

std::optional<RealTimeResult> RemoteDriver::realTime() {
  const TimesMessage& times = end_.times();
  RealTimeResult result;
  result.has_priority = times.has_priority && has_priority_;
  result.has_locked_memory = times.has_locked_memory;
  result.late = times.late;
  result.response = times.response;
  for (int i = 0; i < device::kTickCauses; ++i)
    result.missed_by.push_back(
        {toText(static_cast<device::TickCause>(i)), times.missed_by[static_cast<std::size_t>(i)]});
  result.stale_ticks = times.stale_ticks;
  result.worst_tick = times.worst_tick;
  result.worst_us = times.worst_us;
  result.worst_cause = toText(static_cast<device::TickCause>(times.worst_cause));
  result.faults = times.faults;
  result.physics_missed = clock_.missed();
  result.behind_s = clock_.behind_s();
  result.physics_late = clock_.late();
  if (interruptions_ > 0)
    result.warnings.push_back("number of times that the device was lost: " + std::to_string(interruptions_));
  if (const std::string refused = end_.refusals(); !refused.empty())
    result.warnings.push_back("refused messages of the device: " + refused);
  if (const std::string doubts = end_.doubts(); !doubts.empty()) result.warnings.push_back(doubts);
  return result;
}

/// The remote device, as its node describes it. Only the device node reads and writes the hardware.
class DistantDevice final : public device::Device {
 public:
  explicit DistantDevice(const HelloMessage& hello) : hello_(hello) {}
  device::DeviceSample read() noexcept override { return {{}, {}, 0, Status::Fault}; }
  void write(const Wrench&) noexcept override {}
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return hello_.limits; }
  [[nodiscard]] std::string_view name() const noexcept override { return hello_.name.data(); }

 private:
  HelloMessage hello_;
};

class RemoteHand final : public Hand {
 public:
  RemoteHand(DeviceEnd& end, const Scene& scene, MergedLog* log)
      : end_(end), scene_(scene), log_(log), device_(end.hello()) {}
  std::unique_ptr<HapticDriver> makeDriver(const device::LoopSettings& settings, double physics_s,
                                           const ReportFault& report, device::RunLog* /*log_*/) override {
    return std::make_unique<RemoteDriver>(end_, scene_, settings, physics_s, report, log_);
  }
  device::Device& device() override { return device_; }
  // The driver sends the commands to the device node, so these functions are empty.
  void prepare(const device::OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}
  void step(const device::HeldPart&, const device::HapticLoop&, double) override {}
  [[nodiscard]] device::OperatorPhase phase() const override { return device::OperatorPhase::Idle; }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  DeviceEnd& end_;
  const Scene& scene_;
  MergedLog* log_;
  DistantDevice device_;
};

}  // namespace

std::unique_ptr<Hand> remoteHand(DeviceEnd& end, const Scene& scene, MergedLog* log) {
  return std::make_unique<RemoteHand>(end, scene, log);
}

}  // namespace vps::scenes
