// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/physics_clock.h"

#include <cmath>

#include "simulation/tick_times.h"

namespace vps::scenes {

namespace {

constexpr int kPriority = 70;  // priority of the physics thread. assumed: below the haptic loop's 80

device::Metronome metronomeOf(double period_s) {
  return {std::llround(1e9 * period_s), device::monotonicClock(), std::llround(1e9 * mostLate_s(period_s))};
}

}  // namespace

PhysicsClock::PhysicsClock(double period_s)
    : metronome_(metronomeOf(period_s)), period_s_(period_s), step_s_(period_s) {}

device::RealTimeReport PhysicsClock::start(bool locks_memory) {
  device::RealTimeReport report = device::requestRealTime(kPriority, locks_memory);
  metronome_.start();
  woke_ns_ = 0;
  return report;
}

device::Beat PhysicsClock::wait() noexcept {
  const std::int64_t asked_ns = device::monotonicClock().now_ns();
  busy_s_ = woke_ns_ > 0 ? 1e-9 * static_cast<double>(asked_ns - woke_ns_) : 0;
  const device::Beat beat = metronome_.wait();
  woke_ns_ = beat.woke_ns;
  const double passed_s = 1e-9 * static_cast<double>(beat.periods * metronome_.period_ns());
  missed_ += static_cast<std::uint64_t>(std::llround(passed_s / period_s_)) - 1;
  behind_s_ += passed_s - step_s_;
  late_.add(beat.woke_ns - beat.due_ns);
  return beat;
}

void PhysicsClock::setLoadLevel(double step_s, double period_s) {
  step_s_ = step_s;
  metronome_ = metronomeOf(period_s);
  metronome_.start();
}

TickTimes PhysicsClock::late() const {
  return timesOf(late_.summary(), missed_);
}

void PhysicsClock::stop() noexcept {
  device::leaveRealTime();
}

}  // namespace vps::scenes
