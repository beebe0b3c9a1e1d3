// SPDX-License-Identifier: BSD-3-Clause
#include "physics_clock.h"

#include <cmath>

namespace vps {

namespace {

constexpr int kPriority = 70;  // assumed: below the haptic loop's 80

}  // namespace

PhysicsClock::PhysicsClock(double period_s) : metronome_(std::llround(1e9 * period_s), monotonicClock()) {}

RealTimeReport PhysicsClock::start(bool locks_memory) {
  RealTimeReport report = askForRealTime(kPriority, locks_memory);
  metronome_.start();
  return report;
}

Beat PhysicsClock::wait() noexcept {
  const Beat beat = metronome_.wait();
  missed_ += static_cast<std::uint64_t>(beat.periods - 1);
  return beat;
}

void PhysicsClock::stop() noexcept {
  leaveRealTime();
}

}  // namespace vps
