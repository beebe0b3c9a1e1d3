// SPDX-License-Identifier: BSD-3-Clause
// Timing of physics in real time: when the next step is due, and how well the rate was kept.
#pragma once

#include <algorithm>

#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"
#include "vps_device/tick_statistics.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

/// Greatest delay of a step that is made up for; a greater delay is lost. After a long step, the next steps
/// follow at once until the delay is zero: while a part slides into its bore, single steps take 4 ms, and the
/// steps between these take 0.2 ms. assumed: 20 ms, well below what a person sees as a delay between hand and
/// picture (some 50 ms); two periods where these are longer.
inline double mostLate_s(double period_s) {
  constexpr double kMostLate_s = 0.02;
  return std::max(kMostLate_s, 2 * period_s);
}

/// Used by the physics thread; start() raises the priority of that thread.
class PhysicsClock {
 public:
  explicit PhysicsClock(double period_s);

  /// Starts the clock; the first step is due one period from now.
  /// @param locks_memory  whether to request locked memory
  /// @return what the system granted and refused
  device::RealTimeReport start(bool locks_memory);
  /// Waits until the next step is due; does not wait if the step is late. Steps later than mostLate_s() are
  /// lost.
  device::Beat wait() noexcept;
  /// Returns the thread to normal priority.
  void stop() noexcept;
  /// From the next wait() on, a step of step_s of simulated time is due in each period_s of real time.
  void setLoadLevel(double step_s, double period_s);

  /// Missed periods, in units of the first period.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
  /// Lag of simulated time behind real time, without the delay that is still made up for.
  [[nodiscard]] double behind_s() const noexcept { return behind_s_; }
  /// Delays from a step's due time to its start.
  [[nodiscard]] TickTimes late() const;
  /// Time the caller spent between the last two waits.
  [[nodiscard]] double busy_s() const noexcept { return busy_s_; }

 private:
  device::Metronome metronome_;
  device::TickHistogram late_;
  double period_s_;  ///< period given to the constructor
  double step_s_;
  std::uint64_t missed_ = 0;
  double behind_s_ = 0, busy_s_ = 0;
  std::int64_t woke_ns_ = 0;  ///< end of the last wait; 0: no wait yet
};

}  // namespace vps::scenes
