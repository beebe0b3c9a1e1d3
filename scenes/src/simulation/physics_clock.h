// SPDX-License-Identifier: BSD-3-Clause
// Timing of physics in real time: when the next step is due, and how well the rate was kept.
#pragma once

#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"
#include "vps_scenes/result.h"

namespace vps::scenes::inline v0 {

/// Used by the thread that steps physics, whose priority it raises.
class PhysicsClock {
 public:
  explicit PhysicsClock(double period_s);

  /// The first step is due a period from now.
  /// @param locks_memory  whether to request locked memory
  /// @return what the system granted and refused
  device::RealTimeReport start(bool locks_memory);
  /// Waits until the next step is due; returns at once if it is late.
  device::Beat wait() noexcept;
  /// Returns the thread to normal priority.
  void stop() noexcept;
  /// From the next wait() on: steps of step_s of simulated time, one each period_s of the clock.
  void setLoadLevel(double step_s, double period_s);

  /// Missed periods, in units of the first period.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
  /// Lag of simulated time behind the clock.
  [[nodiscard]] double behind_s() const noexcept { return behind_s_; }
  /// Time the caller spent between the last two waits.
  [[nodiscard]] double busy_s() const noexcept { return busy_s_; }

 private:
  device::Metronome metronome_;
  double period_s_;  ///< as constructed
  double step_s_;
  std::uint64_t missed_ = 0;
  double behind_s_ = 0, busy_s_ = 0;
  std::int64_t woke_ns_ = 0;  ///< end of the last wait; 0: none yet
};

}  // namespace vps::scenes::inline v0
