// SPDX-License-Identifier: BSD-3-Clause
// The beeps of device warnings, one after the other.
#pragma once

#include <deque>

#include "vps_device/device.h"

namespace vps::viewer {

/// assumed: beeps of 90 ms with pauses of 60 ms are counted with ease.
class Beeper {
 public:
  explicit Beeper(int rate_hz) : rate_hz_(rate_hz) {}

  /// Sounds after those that wait. A warning that already waits or sounds is not added again, nor a seventh.
  void add(device::Beep beep);
  /// The next sample, -1 to 1.
  double next();

 private:
  int rate_hz_;
  std::deque<double> pitches_hz_;  ///< the first one sounds
  long at_ = 0;                    ///< samples since it began
};

}  // namespace vps::viewer
