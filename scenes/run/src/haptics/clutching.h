// SPDX-License-Identifier: BSD-3-Clause
// Use of the clutch in a run: handing a part over at the start and end of a step, and indexing along the
// path.
#pragma once

#include <functional>
#include <utility>

#include "haptics/haptic_driver.h"

namespace vps::scenes {

/// Each function waits in physics steps by calling `advance`, and returns false as soon as `advance` returns
/// false (the run cannot continue). During the wait the proxy holds the part at rest.
class ClutchWork {
 public:
  /// `driver` must outlive this object.
  /// @param step_s  duration of the coming physics step in real time, the time of the hand
  ClutchWork(HapticDriver& driver, std::function<double()> step_s)
      : driver_(driver), step_s_(std::move(step_s)) {}

  /// Waits until the clutch that handOver() started to close is closed.
  bool takeHold(const std::function<bool()>& advance) const;
  /// Opens the clutch and waits until it is open.
  bool comeFree(const std::function<bool()>& advance) const;
  /// Fades out the coupling gains over the clutch's time, so that the spring's energy is released gradually
  /// and the part comes to rest on its seat before it is released.
  /// @param advance  receives the remaining share of the gains, down to 0
  bool setDown(const std::function<bool(double share)>& advance) const;
  /// Opens the clutch, recentres the handle at the start of the next segment, closes the clutch and
  /// continues.
  bool index(const std::function<bool()>& advance) const;

 private:
  bool waitForClutch(double ratio, const std::function<bool()>& advance) const;
  bool advanceFor(double seconds, const std::function<bool()>& advance) const;

  HapticDriver& driver_;
  std::function<double()> step_s_;
};

}  // namespace vps::scenes
