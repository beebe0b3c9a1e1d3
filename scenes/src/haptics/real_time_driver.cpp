// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "haptics/clocked_driver.h"
#include "haptics/haptic_log.h"
#include "simulation/physics_clock.h"
#include "vps_device/real_time_loop.h"

namespace vps::scenes {
namespace {

constexpr double kCatchUp =
    20;  // periods that a simulated device makes up for; beyond that its time stands still

constexpr std::chrono::microseconds kOrderWait{200};  // assumed: well below a haptic period

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
  RealTimeDriver(Hand& hand, CouplingPort& port, const device::LoopSettings& settings, double physics_s,
                 const TellFault& tell, device::RunLog* log)
      : ClockedDriver(hand, settings, tell),
        port_(port),
        physics_s_(physics_s),
        haptic_log_(log),
        tapped_(hand.device(), haptic_log_),
        loop_(tapped_, port, told(settings), realTimeSettings()),
        clock_(physics_s) {}
  ~RealTimeDriver() override { pause(); }

  void pause() override {
    if (loop_.isRunning()) {
      loop_.stop();
      meet(loop_.loop(), device::SyncEventKind::Paused);
      haptic_log_.passThrough(device::SyncEventKind::Paused);
      look(LoopView::of(loop_.loop(), hand_.phase()));
    }
    clock_.stop();
  }
  void resume() override {
    rearmIfFaulted();
    if (loop_.isRunning()) return;
    phase_.store(hand_.phase());
    const device::RealTimeReport report = loop_.start();
    result_.has_priority = report.has_priority;
    result_.has_locked_memory = report.has_locked_memory;
    result_.warnings = report.warnings;
    result_.has_priority = clock_.start(false).has_priority && result_.has_priority;
  }
  std::uint64_t missed() override { return loop_.statistics().summary().missed; }

  bool advance(const HeldPart& part) override {
    part_.write(part);
    clock_.wait();
    countFaults();
    const LoopView& view = views_.read();
    if (view.tick > ordered_tick_) known_phase_ = view.phase;  // else it is of before the order
    haptic_log_.passUpTo(view.tick);
    haptic_log_.tell({view.report.time_s, view.tick, 1, 0, device::SyncEventKind::Step});
    look(view);
    return true;
  }
  bool hasSettled(bool is_ready) override {
    if (is_ready) haptic_log_.tell({view_.report.time_s, view_.tick, 1, 0, device::SyncEventKind::Settled});
    return is_ready;
  }
  device::OperatorPhase phase() override { return known_phase_; }
  [[nodiscard]] double busy_s() const override { return clock_.busy_s(); }
  void setLoadLevel(double step_s, double period_s, const CouplingGains& gains) override {
    clock_.setLoadLevel(step_s, period_s);
    if (!loop_.isRunning()) return loop_.loop().setGains(gains);
    while (loop_.isRunning() && !loop_.setGains(gains)) std::this_thread::sleep_for(kOrderWait);
  }
  TickTimes times() override {
    const device::TickStatistics::Summary all = loop_.statistics().summary();
    return timesOf(all.tick, all.missed);
  }
  std::optional<RealTimeResult> realTime() override;

 protected:
  void order(device::SyncEventKind what) override {
    order_.store(what, std::memory_order_release);
    while (order_.load(std::memory_order_acquire) != kNoOrder && loop_.isRunning())
      std::this_thread::sleep_for(kOrderWait);
    if (!loop_.isRunning()) obeyOrder(loop_.loop());  // nobody else would
    known_phase_ = ordered_phase_;
    haptic_log_.passThrough(what);
  }
  void store(const PhysicsSnapshot& snapshot) override { snapshots_.write(snapshot); }

 private:
  static constexpr device::SyncEventKind kNoOrder = device::SyncEventKind::Tick;

  // The loop's thread from here on, while it runs.
  void meet(const device::HapticLoop& loop, device::SyncEventKind kind, std::int64_t periods = 1,
            std::int32_t snapshot = 0) {
    haptic_log_.add(device::SyncEvent{loop.last().time_s, static_cast<std::int32_t>(loop.ticks()),
                                      static_cast<std::int32_t>(periods), snapshot, kind});
  }
  void obeyOrder(device::HapticLoop& loop) {
    const device::SyncEventKind what = order_.load(std::memory_order_acquire);
    if (what == kNoOrder) return;
    obey(loop, what);
    meet(loop, what);
    ordered_phase_ = hand_.phase();
    phase_.store(ordered_phase_);
    ordered_tick_ = static_cast<std::int32_t>(loop.ticks());
    order_.store(kNoOrder, std::memory_order_release);
  }
  void beforeTick(device::HapticLoop& loop, std::int64_t periods) {
    obeyOrder(loop);
    const PhysicsSnapshot& snapshot = snapshots_.read();
    show(loop, port_, snapshot);
    const auto tick = static_cast<std::int32_t>(loop.ticks() + 1);
    haptic_log_.add(device::SyncEvent{loop.last().time_s, tick, static_cast<std::int32_t>(periods),
                                      snapshot.number, device::SyncEventKind::Tick});
  }

  device::LoopSettings told(device::LoopSettings settings) {
    settings.events = &events_;
    return settings;
  }
  device::RealTimeSettings realTimeSettings() {
    device::RealTimeSettings settings;
    settings.stale_s = 2 * physics_s_;
    settings.physics_limit_s = physicsLimit_s(physics_s_);
    settings.before = [this](device::HapticLoop& loop, std::int64_t periods) { beforeTick(loop, periods); };
    settings.beside = [this](device::HapticLoop& loop, double dt_s) { moveHand(loop, dt_s); };
    return settings;
  }

  // The simulated device and hand go on as far as time did, in steps they are made for.
  void moveHand(device::HapticLoop& loop, double dt_s) {
    const HeldPart& part = part_.read();
    const double period_s = loop.settings().period_s;
    const int steps = static_cast<int>(std::lround(std::min(dt_s / period_s, kCatchUp)));
    for (int i = 0; i < steps; ++i) hand_.step(part, loop, period_s);
    phase_.store(hand_.phase());
    views_.write(LoopView::of(loop, hand_.phase()));
  }

  // The physics thread.
  void countFaults() {
    for (device::DeviceEvent event; events_.pop(event);)
      result_.faults += device::severityOf(event.kind) == device::Severity::Fault;
  }

  CouplingPort& port_;
  double physics_s_;
  device::DeviceEventQueue events_;
  HapticLog haptic_log_;
  device::TappedDevice tapped_;
  TripleBuffer<HeldPart> part_;
  TripleBuffer<PhysicsSnapshot> snapshots_;
  TripleBuffer<LoopView> views_;
  std::atomic<device::OperatorPhase> phase_{device::OperatorPhase::Idle};
  device::OperatorPhase known_phase_ = device::OperatorPhase::Idle;  ///< as of the last look or order
  std::atomic<device::SyncEventKind> order_{kNoOrder};
  std::int32_t ordered_tick_ = 0;  ///< ticks before the last order; handed over with order_
  device::OperatorPhase ordered_phase_ = device::OperatorPhase::Idle;  ///< after it, likewise
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

std::unique_ptr<HapticDriver> makeRealTimeDriver(Hand& hand, CouplingPort& port,
                                                 const device::LoopSettings& settings, double physics_s,
                                                 const TellFault& tell, device::RunLog* log) {
  return std::make_unique<RealTimeDriver>(hand, port, settings, physics_s, tell, log);
}

}  // namespace vps::scenes
