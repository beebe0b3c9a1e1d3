// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "haptic_side.h"
#include "vps_device/real_time_loop.h"

namespace vps {
namespace {

constexpr int kPhysicsPriority = 70;  // assumed: below the haptic loop's 80
constexpr double kCatchUp =
    20;  // periods that a simulated device makes up for; beyond that its time stands still

constexpr std::chrono::microseconds kOrderWait{200};  // assumed: well below a haptic period

double microseconds(std::int64_t ns) {
  return 1e-3 * static_cast<double>(ns);
}

TickTimes timesOf(const TickHistogram::Summary& all, std::uint64_t missed) {
  return {all.count,
          missed,
          microseconds(all.p50_ns),
          microseconds(all.p99_ns),
          microseconds(all.p999_ns),
          microseconds(all.max_ns),
          0};
}

class RealTimeSide final : public HapticSide {
 public:
  RealTimeSide(Hand& hand, CouplingPort& port, LoopSettings settings, double physics_s, const TellFault& tell)
      : hand_(hand),
        settings_(settings),
        physics_s_(physics_s),
        step_s_(physics_s),
        tell_(tell),
        loop_(hand.device(), port, told(settings), realTimeSettings()),
        metronome_(std::llround(1e9 * physics_s), monotonicClock()) {}
  ~RealTimeSide() override { pause(); }

  void pause() override {
    loop_.stop();
    leaveRealTime();
  }
  void resume() override {
    if (loop_.isRunning()) {
      if (loop_.latest().safety.fault != SafetyFault::None) loop_.rearm();
      return;
    }
    if (loop_.loop().safety().fault != SafetyFault::None) loop_.loop().rearm();
    phase_.store(hand_.phase());
    const RealTimeReport report = loop_.start();
    result_.has_priority = report.has_priority;
    result_.has_locked_memory = report.has_locked_memory;
    result_.warnings = report.warnings;
    const RealTimeReport physics = askForRealTime(kPhysicsPriority, false);
    result_.has_priority = result_.has_priority && physics.has_priority;
    metronome_.start();
    woke_ns_ = 0;
  }
  [[nodiscard]] const LoopSettings& settings() const override { return settings_; }
  [[nodiscard]] bool isByClock() const override { return true; }
  std::uint64_t missed() override { return loop_.statistics().summary().missed; }

  void requireReachable(const SceneStep& step) const override { hand_.requireReachable(step); }
  void grasp(const Pose& X_WG) override {
    if (loop_.isRunning())
      loop_.grasp(X_WG);
    else
      loop_.loop().grasp(X_WG);
  }
  void begin(const OperatorTask& task, std::size_t step, double now_s) override {
    hand_.prepare(task, step, now_s);
    if (loop_.isRunning())
      order(Order::Begin);
    else
      hand_.begin();
  }
  void letGo() override {
    if (loop_.isRunning())
      loop_.release();
    else
      loop_.loop().release();
  }
  void goBack(const SceneStep* next) override {
    next_ = next;
    if (loop_.isRunning())
      order(Order::GoBack);
    else
      hand_.goBack(next_);
  }

  bool advance(const HeldPart& part) override {
    part_.write(part);
    const std::int64_t asked_ns = monotonicClock().now_ns();
    busy_s_ = woke_ns_ > 0 ? 1e-9 * static_cast<double>(asked_ns - woke_ns_) : 0;
    const Beat beat = metronome_.wait();
    woke_ns_ = beat.woke_ns;
    const double passed_s = 1e-9 * static_cast<double>(beat.periods * metronome_.period_ns());
    result_.physics_missed += static_cast<std::uint64_t>(std::llround(passed_s / physics_s_)) - 1;
    result_.behind_s += passed_s - step_s_;
    tellEvents();
    return true;
  }
  [[nodiscard]] double busy_s() const override { return busy_s_; }
  void setPace(double step_s, double period_s, const CouplingGains& gains) override {
    step_s_ = step_s;
    metronome_ = Metronome(std::llround(1e9 * period_s), monotonicClock());
    metronome_.start();
    if (loop_.isRunning())
      loop_.setGains(gains);
    else
      loop_.loop().setGains(gains);
  }
  void noteStored(double stored_J, double actuator_J) override { loop_.noteStored(stored_J, actuator_J); }
  OperatorPhase phase() override { return loop_.isRunning() ? phase_.load() : hand_.phase(); }
  const TickReport& last() override { return loop_.latest().report; }
  HandLedger ledger() override { return loop_.latest().ledger; }
  TickTimes times() override {
    const TickStatistics::Summary all = loop_.statistics().summary();
    return timesOf(all.tick, all.missed);
  }
  std::optional<RealTimeResult> realTime() override;

 private:
  /// What the hand is told while the loop runs; the loop's thread does it.
  enum class Order { None, Begin, GoBack };

  /// Waits for the tick that does it.
  void order(Order what) {
    order_.store(what, std::memory_order_release);
    while (order_.load(std::memory_order_acquire) != Order::None && loop_.isRunning())
      std::this_thread::sleep_for(kOrderWait);
    if (!loop_.isRunning()) obey();  // it stopped meanwhile: nobody else would
  }

  // The loop's thread. A grasp that was asked for before comes first.
  void obey() {
    const Order what = order_.load(std::memory_order_acquire);
    if (what == Order::None || (loop_.isRunning() && loop_.hasOpenRequests())) return;
    if (what == Order::Begin) hand_.begin();
    if (what == Order::GoBack) hand_.goBack(next_);
    phase_.store(hand_.phase());
    order_.store(Order::None, std::memory_order_release);
  }

  LoopSettings told(LoopSettings settings) {
    settings.events = &events_;
    return settings;
  }
  RealTimeSettings realTimeSettings() {
    RealTimeSettings settings;
    settings.stale_s = 2 * physics_s_;
    settings.physics_limit_s = std::max(settings.physics_limit_s, 10 * physics_s_);
    settings.beside = [this](HapticLoop& loop, double dt_s) { moveHand(loop, dt_s); };
    return settings;
  }

  // The loop's thread: the simulated device and hand go on as far as time did, in steps they are made for.
  void moveHand(HapticLoop& loop, double dt_s) {
    obey();
    const HeldPart& part = part_.read();
    const double period_s = loop.settings().period_s;
    const int steps = static_cast<int>(std::lround(std::min(dt_s / period_s, kCatchUp)));
    for (int i = 0; i < steps; ++i) hand_.step(part, loop, period_s);
    phase_.store(hand_.phase());
  }

  void tellEvents() {
    for (DeviceEvent event; events_.pop(event);) {
      if (severityOf(event.kind) != Severity::Fault) continue;
      ++result_.faults;
      tell_(toText(event.kind));
    }
  }

  Hand& hand_;
  LoopSettings settings_;
  double physics_s_;          ///< as asked
  double step_s_;             ///< of simulated time, now
  double busy_s_ = 0;         ///< of the physics thread, between the last two waits
  std::int64_t woke_ns_ = 0;  ///< from the last; 0: not yet
  TellFault tell_;
  DeviceEventQueue events_;
  TripleBuffer<HeldPart> part_;
  std::atomic<OperatorPhase> phase_{OperatorPhase::Idle};
  std::atomic<Order> order_{Order::None};
  const SceneStep* next_ = nullptr;  ///< of Order::GoBack
  RealTimeResult result_;
  RealTimeLoop loop_;
  Metronome metronome_;
};

std::optional<RealTimeResult> RealTimeSide::realTime() {
  tellEvents();
  const TickStatistics::Summary all = loop_.statistics().summary();
  RealTimeResult result = result_;
  result.late = timesOf(all.late, 0);
  result.response = timesOf(all.response, 0);
  for (int i = 0; i < kTickCauses; ++i)
    result.missed_by.push_back(
        {toText(static_cast<TickCause>(i)), all.missed_by[static_cast<std::size_t>(i)]});
  result.stale_ticks = all.stale;
  result.worst_tick = all.worst.tick;
  result.worst_us = microseconds(all.worst.response_ns());
  result.worst_cause = toText(all.worst.cause());
  return result;
}

}  // namespace

std::unique_ptr<HapticSide> realTimeSide(Hand& hand, CouplingPort& port, const LoopSettings& settings,
                                         double physics_s, const TellFault& tell) {
  return std::make_unique<RealTimeSide>(hand, port, settings, physics_s, tell);
}

}  // namespace vps
