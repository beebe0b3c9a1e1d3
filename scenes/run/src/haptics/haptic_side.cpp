// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/haptic_side.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "simulation/tick_times.h"

namespace vps::scenes {

namespace {

// Greatest time of missed periods that a simulated device makes up for; time beyond kCatchUp_s is skipped.
// Half of the time after which the dual arm's watchdog trips (20 ms without a command), so that a pause of
// this program does not trip it.
constexpr double kCatchUp_s = 10e-3;

constexpr std::chrono::microseconds kCommandPoll{200};  // poll period. assumed: well below a haptic period

double microseconds(std::int64_t ns) {
  return 1e-3 * static_cast<double>(ns);
}

}  // namespace

HapticSide::HapticSide(Hand& hand, device::CouplingPort& port, const device::LoopSettings& settings,
                       const HapticTiming& timing, device::RunLog& log)
    : hand_(hand),
      log_(log),
      is_silent_(timing.is_silent),
      tapped_(hand.device(), log),
      loop_(tapped_, port, withEvents(settings), realTimeSettings(timing)) {}

device::LoopSettings HapticSide::withEvents(device::LoopSettings settings) {
  settings.events = &events_;
  return settings;
}

device::RealTimeSettings HapticSide::realTimeSettings(const HapticTiming& timing) {
  device::RealTimeSettings settings;
  settings.stale_s = timing.stale_s;
  settings.physics_limit_s = timing.physics_limit_s;
  settings.before_tick = [this](device::HapticLoop& loop, std::int64_t periods) {
    watchPhysics(loop);
    logTick(loop, periods);
  };
  settings.after_tick = [this](device::HapticLoop& loop, double dt_s) { moveHand(loop, dt_s); };
  settings.on_call = [this](device::HapticLoop& loop, std::int32_t) {
    scenes::carryOut(hand_, loop, command_);
    logEvent(loop, command_.what);
    publishState(loop);
  };
  return settings;
}

void HapticSide::start() {
  if (loop_.isRunning()) return;
  const device::RealTimeReport report = loop_.start();
  result_.has_priority = report.has_priority;
  result_.has_locked_memory = report.has_locked_memory;
  result_.warnings = report.warnings;
}

bool HapticSide::stop() {
  if (!loop_.isRunning()) return false;
  loop_.stop();
  logEvent(loop_.loop(), device::SyncEventKind::Paused);
  return true;
}

void HapticSide::carryOut(const HandCommand& command) {
  prepare(hand_, command);
  command_ = command;
  loop_.call(0);  // commands come one at a time, so the ring has room
  while (loop_.hasOpenRequests() && loop_.isRunning()) std::this_thread::sleep_for(kCommandPoll);
  if (!loop_.isRunning()) loop_.handleRequests();
}

void HapticSide::setGains(const CouplingGains& gains) {
  if (!loop_.isRunning()) return loop_.loop().setGains(gains);
  while (loop_.isRunning() && !loop_.setGains(gains)) std::this_thread::sleep_for(kCommandPoll);
}

// logEvent() is called by the loop's thread while the loop runs, else by the thread that uses this object.
void HapticSide::logEvent(const device::HapticLoop& loop, device::SyncEventKind kind) {
  log_.add(device::SyncEvent{loop.last().time_s, static_cast<std::int32_t>(loop.ticks()), 1, 0, kind});
}

void HapticSide::logTick(const device::HapticLoop& loop, std::int64_t periods) {
  const auto tick = static_cast<std::int32_t>(loop.ticks() + 1);
  log_.add(device::SyncEvent{loop.last().time_s, tick, static_cast<std::int32_t>(periods),
                             loop.received().step, device::SyncEventKind::Tick});
}

// While no part is held, silence of physics is no fault, since there is no force that a fault would have to
// remove.
void HapticSide::watchPhysics(device::HapticLoop& loop) {
  if (!is_silent_ || !loop.isHolding() || !loop.received().part.is_coupled) return;
  if (loop.state().safety.fault != device::SafetyFault::None || !is_silent_()) return;
  logEvent(loop, device::SyncEventKind::Silent);
  loop.latchFault(device::SafetyFault::PhysicsStalled);
}

// The simulated device and hand advance by the elapsed time, in steps of the loop's period.
void HapticSide::moveHand(device::HapticLoop& loop, double dt_s) {
  const double period_s = loop.settings().period_s;
  const double most = std::max(1.0, std::floor(kCatchUp_s / period_s));
  const int steps = static_cast<int>(std::lround(std::min(dt_s / period_s, most)));
  for (int i = 0; i < steps; ++i) hand_.step(loop.received().held, loop, period_s);
  publishState(loop);
}

void HapticSide::publishState(const device::HapticLoop& loop) {
  tick_.store(static_cast<std::int32_t>(loop.ticks()), std::memory_order_release);
  state_.store(device::toByte(hand_.state()), std::memory_order_release);
}

void HapticSide::countFaults() {
  for (device::DeviceEvent event; events_.pop(event);) {
    result_.faults += device::severityOf(event.kind) == device::Severity::Fault;
    if (reported_.size() < device::DeviceEventQueue::kCapacity) reported_.push_back(event);
  }
}

void HapticSide::passEvents(const std::function<void(const device::DeviceEvent&)>& to) {
  for (const device::DeviceEvent& event : reported_) to(event);
  reported_.clear();
}

TickTimes HapticSide::times() const {
  const device::TickStatistics::Summary all = loop_.statistics().summary();
  return timesOf(all.tick, all.missed);
}

RealTimeResult HapticSide::realTime() {
  countFaults();
  const device::TickStatistics::Summary all = loop_.statistics().summary();
  RealTimeResult result = result_;
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

}  // namespace vps::scenes
