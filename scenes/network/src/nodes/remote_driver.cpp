// SPDX-License-Identifier: BSD-3-Clause
// A run whose haptic loop is in the device's node. Physics goes by the clock, as with makeRealTimeDriver().
//
// A device that is lost stops physics, so that the part stays where it is. When the device, or a new process
// with the same device, is back, it is brought to where the lost one was, and physics goes on.
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

/// A live device that is silent for longer stops physics as well. assumed: longer than any hiccup of a
/// scheduler; the proxy stands still meanwhile.
constexpr double kHiccup_s = 0.1;
constexpr double kLastLog_s = 2;                  ///< assumed: DDS sends again within a tenth
constexpr std::uint64_t kAdvancesPerDoubt = 256;  // assumed: some times a second
/// Good physics steps before the loop is re-armed, if its node allows that.
constexpr int kStepsUntilRearm = 50;

/// How many of a path's way points are still ahead of a part at p_W: those after the leg nearest to it.
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
    // Only now: it reports faults, which a replay logs after the step, too.
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
  /// Once the device was lost, a recording has ended.
  [[nodiscard]] RequestMessage setup() const {
    return {.kind = RequestKind::Setup, .keeps_log = log_ != nullptr && interruptions_ == 0, .gains = gains_};
  }
  /// Notes what a device that joins later has to be told.
  void keep(const HandCommand& command);
  /// False: the device was lost meanwhile.
  bool ask(const RequestMessage& request) {
    if (!end_.request(request, [this] { showThatPhysicsLives(); })) return false;
    known_state_ = device::stateFromByte(end_.reply().hand);
    return true;
  }
  /// While a request is on its way physics stands still. The part does so, too, and its state is as new as
  /// the proxy's, so that the loop does not take it for stalled. Not while a run is recorded, since a replay
  /// knows the states of steps only.
  void showThatPhysicsLives();
  /// A device that is lost before it has carried out the request is told so when it is back.
  void askUntilDone(const RequestMessage& request) {
    if (!ask(request) && !end_.isStopped()) waitAndRestore();
  }
  /// Waits for a lost device. False: stopped.
  bool keepDevice();
  bool waitAndRestore();
  /// Brings a new process of the device to where the lost one was in that phase. False: it was lost again.
  bool restore(device::OperatorPhase phase);
  bool restoreHold(device::OperatorPhase phase);
  void rearmWhenGood();
  /// A state that was sent before the last request was carried out shows the hand as it was before: a phase
  /// that is over, such as Done of the step before.
  void takeState() {
    const HapticMessage* message = end_.takeState();
    if (message == nullptr || message->state.tick < end_.reply().tick) return;
    if (message->state.tick > end_.reply().tick) known_state_ = device::stateFromByte(message->hand);
    newest_ = message->state;
  }
  /// Over UDP a reply may come before the states that were sent before it.
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
  /// All of a loop that has stopped. What has not come by then is lost.
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
  MergedLog* log_;                     ///< null: nothing is recorded
  device::OperatorState known_state_;  ///< as of the last advance() or command
  device::HapticState newest_;         ///< of the loop; view_ follows in advance()
  device::PhysicsState part_;          ///< the last one
  CouplingGains gains_;
  std::optional<HandCommand> begun_;  ///< the hand works on this
  Pose X_WG_;                         ///< of the part that the hand holds
  bool is_holding_ = false, is_clutch_open_ = false;
  bool is_running_ = false, is_wanted_ = false, has_priority_ = false;
  int good_steps_ = 0;  ///< since a fault
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
      part_.part.is_coupled = false;  // the last state was another part's
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
  end_.say("the device is silent; physics waits for it");
  return waitAndRestore();
}

bool RemoteDriver::waitAndRestore() {
  const device::OperatorPhase phase = known_state_.phase;
  ++interruptions_;
  if (log_ != nullptr) log_->lose(1);  // a recording ends here: what the lost device did is not known
  for (;;) {
    while (!end_.isPresent() || end_.silence_s() > kPeerLimit_s) {
      if (end_.isStopped()) return false;
      end_.poll();
      if (end_.joins() != joins_) break;
      if (end_.isPresent() && end_.takeState() != nullptr) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (end_.joins() == joins_) break;  // the same process goes on
    joins_ = end_.joins();
    if (restore(phase)) break;
    if (end_.isStopped()) return false;
  }
  end_.say("the device is back; physics goes on");
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
  // The empty hand goes to where the step begins, and takes the part from there.
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

// As a person does; the force then returns gradually, from a new grasp of the part where it is.
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
    result.warnings.push_back("the device was lost " + std::to_string(interruptions_) + " times");
  if (const std::string refused = end_.refusals(); !refused.empty())
    result.warnings.push_back("messages of the device that were refused: " + refused);
  if (const std::string doubts = end_.doubts(); !doubts.empty()) result.warnings.push_back(doubts);
  return result;
}

/// The device as its node describes it. Only its node reads and writes it.
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
  // Its driver sends the commands to the device's node.
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
