// SPDX-License-Identifier: BSD-3-Clause
// A run in real time: the haptic loop on a thread of its own, physics by the clock.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "haptics/clocked_driver.h"
#include "haptics/haptic_log.h"
#include "simulation/physics_clock.h"
#include "vps_device/real_time_loop.h"

namespace vps::scenes::inline v0 {
namespace {

// Missed periods that a simulated device makes up for; beyond that its time stands still.
constexpr double kCatchUpPeriods = 20;

constexpr std::chrono::microseconds kCommandPoll{200};  // assumed: well below a haptic period

double microseconds(std::int64_t ns) {
  return 1e-3 * static_cast<double>(ns);
}

TickTimes timesOf(const device::TickHistogram::Summary& all, std::uint64_t missed) {
  return {all.count,
          missed,
          microseconds(all.p50_ns),
          microseconds(all.p99_ns),
          microseconds(all.p999_ns),
          microseconds(all.max_ns),
          0};
}

class RealTimeDriver final : public ClockedDriver {
 public:
  RealTimeDriver(Hand& hand, device::CouplingPort& port, const device::LoopSettings& settings,
                 double physics_s, const ReportFault& report, device::RunLog* log)
      : ClockedDriver(hand, settings, report),
        port_(port),
        physics_s_(physics_s),
        haptic_log_(log),
        tapped_(hand.device(), haptic_log_),
        loop_(tapped_, port, withEvents(settings), realTimeSettings()),
        clock_(physics_s) {}
  ~RealTimeDriver() override { pause(); }

  void pause() override {
    if (loop_.isRunning()) {
      loop_.stop();
      logEvent(loop_.loop(), device::SyncEventKind::Paused);
      haptic_log_.passUntil(device::SyncEventKind::Paused);
      setView(loop_.loop().state());
    }
    clock_.stop();
  }
  void resume() override {
    rearmIfFaulted();
    if (loop_.isRunning()) return;
    const device::RealTimeReport report = loop_.start();
    result_.has_priority = report.has_priority;
    result_.has_locked_memory = report.has_locked_memory;
    result_.warnings = report.warnings;
    result_.has_priority = clock_.start(false).has_priority && result_.has_priority;
  }
  std::uint64_t missed() override { return loop_.statistics().summary().missed; }

  bool advance() override {
    clock_.wait();
    countFaults();
    const device::HapticState& view = port_.haptic.read();
    known_state_ = device::stateFromByte(state_.load(std::memory_order_acquire));
    haptic_log_.passUpTo(view.tick);
    haptic_log_.addFromPhysics({view.report.time_s, view.tick, 1, 0, device::SyncEventKind::Step});
    setView(view);
    return true;
  }
  bool hasSettled(bool is_ready) override {
    if (is_ready)
      haptic_log_.addFromPhysics({view_.report.time_s, view_.tick, 1, 0, device::SyncEventKind::Settled});
    return is_ready;
  }
  device::OperatorState state() override { return known_state_; }
  [[nodiscard]] double busy_s() const override { return clock_.busy_s(); }
  void setLoadLevel(double step_s, double period_s, const CouplingGains& gains) override {
    clock_.setLoadLevel(step_s, period_s);
    if (!loop_.isRunning()) return loop_.loop().setGains(gains);
    while (loop_.isRunning() && !loop_.setGains(gains)) std::this_thread::sleep_for(kCommandPoll);
  }
  TickTimes times() override {
    const device::TickStatistics::Summary all = loop_.statistics().summary();
    return timesOf(all.tick, all.missed);
  }
  std::optional<RealTimeResult> realTime() override;
  void passEvents(const std::function<void(const device::DeviceEvent&)>& to) override {
    for (const device::DeviceEvent& event : reported_) to(event);
    reported_.clear();
  }

 protected:
  void command(device::SyncEventKind what) override {
    loop_.call(static_cast<std::int32_t>(what));  // one at a time: the ring has room
    while (loop_.hasOpenRequests() && loop_.isRunning()) std::this_thread::sleep_for(kCommandPoll);
    if (!loop_.isRunning()) loop_.handleRequests();
    known_state_ = device::stateFromByte(state_.load(std::memory_order_acquire));
    haptic_log_.passUntil(what);
  }
  void store(const device::PhysicsState& state) override { port_.physics.write(state); }

 private:
  // Called by the loop's thread while it runs, else by the physics thread.
  void logEvent(const device::HapticLoop& loop, device::SyncEventKind kind) {
    haptic_log_.add(
        device::SyncEvent{loop.last().time_s, static_cast<std::int32_t>(loop.ticks()), 1, 0, kind});
  }
  void carryOutAndLog(device::HapticLoop& loop, device::SyncEventKind what) {
    carryOut(loop, what);
    logEvent(loop, what);
    state_.store(device::toByte(hand_.state()), std::memory_order_release);
  }
  void logTick(const device::HapticLoop& loop, std::int64_t periods) {
    const auto tick = static_cast<std::int32_t>(loop.ticks() + 1);
    haptic_log_.add(device::SyncEvent{loop.last().time_s, tick, static_cast<std::int32_t>(periods),
                                      loop.received().step, device::SyncEventKind::Tick});
  }

  device::LoopSettings withEvents(device::LoopSettings settings) {
    settings.events = &events_;
    return settings;
  }
  device::RealTimeSettings realTimeSettings() {
    device::RealTimeSettings settings;
    settings.stale_s = 2 * physics_s_;
    settings.physics_limit_s = physicsLimit_s(physics_s_);
    settings.before_tick = [this](device::HapticLoop& loop, std::int64_t periods) { logTick(loop, periods); };
    settings.after_tick = [this](device::HapticLoop& loop, double dt_s) { moveHand(loop, dt_s); };
    settings.on_call = [this](device::HapticLoop& loop, std::int32_t code) {
      carryOutAndLog(loop, static_cast<device::SyncEventKind>(code));
    };
    return settings;
  }

  // The simulated device and hand advance by the elapsed time, in steps of the period they are made for.
  void moveHand(device::HapticLoop& loop, double dt_s) {
    const double period_s = loop.settings().period_s;
    const int steps = static_cast<int>(std::lround(std::min(dt_s / period_s, kCatchUpPeriods)));
    for (int i = 0; i < steps; ++i) hand_.step(loop.received().held, loop, period_s);
    state_.store(device::toByte(hand_.state()), std::memory_order_release);
  }

  // The physics thread.
  void countFaults() {
    for (device::DeviceEvent event; events_.pop(event);) {
      result_.faults += device::severityOf(event.kind) == device::Severity::Fault;
      if (reported_.size() < device::DeviceEventQueue::kCapacity) reported_.push_back(event);
    }
  }

  device::CouplingPort& port_;
  double physics_s_;
  device::DeviceEventQueue events_;
  std::vector<device::DeviceEvent> reported_;  ///< popped, and not passed on yet
  HapticLog haptic_log_;
  device::TappedDevice tapped_;
  std::atomic<std::uint8_t> state_{device::toByte({})};  ///< of the hand, by its thread
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free, "the haptic thread must not wait for a lock");
  /// As of the last advance() or command, so that it stays the same within a physics step.
  device::OperatorState known_state_;
  RealTimeResult result_;
  device::RealTimeLoop loop_;
  PhysicsClock clock_;
};

std::optional<RealTimeResult> RealTimeDriver::realTime() {
  countFaults();
  const device::TickStatistics::Summary all = loop_.statistics().summary();
  RealTimeResult result = result_;
  result.physics_missed = clock_.missed();
  result.behind_s = clock_.behind_s();
  result.late = timesOf(all.late, 0);
  result.response = timesOf(all.response, 0);
  for (int i = 0; i < device::kTickCauses; ++i)
    result.missed_by.push_back(
        {toText(static_cast<device::TickCause>(i)), all.missed_by[static_cast<std::size_t>(i)]});
  result.stale_ticks = all.stale;
  result.worst_tick = all.worst.tick;
  result.worst_us = microseconds(all.worst.response_ns());
  result.worst_cause = toText(all.worst.cause());
  return result;
}

}  // namespace

double physicsLimit_s(double physics_s) {
  return std::max(device::RealTimeSettings{}.physics_limit_s, 10 * physics_s);
}

std::unique_ptr<HapticDriver> makeRealTimeDriver(Hand& hand, device::CouplingPort& port,
                                                 const device::LoopSettings& settings, double physics_s,
                                                 const ReportFault& report, device::RunLog* log) {
  return std::make_unique<RealTimeDriver>(hand, port, settings, physics_s, report, log);
}

}  // namespace vps::scenes::inline v0
