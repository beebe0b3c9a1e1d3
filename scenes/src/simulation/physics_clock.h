// SPDX-License-Identifier: BSD-3-Clause
// Physics by the clock: when its next step is due, and how well that was kept.
#pragma once

#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"
#include "vps_scenes/result.h"

namespace vps::scenes {

/// Used by the thread that steps physics, which is also the one whose priority it asks for.
class PhysicsClock {
 public:
  explicit PhysicsClock(double period_s);

  /// The first step is due a period from now. @param locks_memory  ask for that too
  /// @return what the system refused
  device::RealTimeReport start(bool locks_memory);
  /// Until the next step is due; at once where it is late.
  device::Beat wait() noexcept;
  /// Gives the priority back.
  void stop() noexcept;
  /// From the next wait() on: steps of step_s of simulated time, one each period_s of the clock's.
  void setLoadLevel(double step_s, double period_s);

  /// Periods, of those first asked for, without a step of their own.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
  /// By how much simulated time is behind the clock's.
  [[nodiscard]] double behind_s() const noexcept { return behind_s_; }
  /// What the caller did between the last two waits.
  [[nodiscard]] double busy_s() const noexcept { return busy_s_; }

 private:
  device::Metronome metronome_;
  double period_s_;  ///< as first asked for
  double step_s_;
  std::uint64_t missed_ = 0;
  double behind_s_ = 0, busy_s_ = 0;
  std::int64_t woke_ns_ = 0;  ///< from the last wait; 0: not yet
};

}  // namespace vps::scenes
