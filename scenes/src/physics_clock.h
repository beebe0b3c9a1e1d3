// SPDX-License-Identifier: BSD-3-Clause
// Physics by the clock: when its next step is due, and how well that was kept.
#pragma once

#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"
#include "vps_scenes/result.h"

namespace vps {

/// Used by the thread that steps physics, which is also the one whose priority it asks for.
class PhysicsClock {
 public:
  explicit PhysicsClock(double period_s);

  /// The first step is due a period from now. @param locks_memory  ask for that too
  /// @return what the system refused
  RealTimeReport start(bool locks_memory);
  /// Until the next step is due; at once where it is late.
  Beat wait() noexcept;
  /// Gives the priority back.
  void stop() noexcept;

  /// Periods without a step of their own.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  Metronome metronome_;
  std::uint64_t missed_ = 0;
};

}  // namespace vps
