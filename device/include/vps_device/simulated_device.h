// SPDX-License-Identifier: BSD-3-Clause
// A device whose mechanics are simulated: a hand model moves it instead of a person.
#pragma once

#include "vps_device/device.h"
#include "vps_device/export.h"
#include "vps_device/hand_force.h"

namespace vps::device {

class VPS_DEVICE_API SimulatedDevice : public Device {
 public:
  /// Advances the mechanics by dt_s with the hand `hand` (in D) on the handle. Never throws or allocates.
  virtual void step(double dt_s, const HandForce& hand) noexcept = 0;

  /// The true state of the handle, for tests and for the operator's own senses; the loop sees only read().
  [[nodiscard]] virtual const Pose& truePose() const noexcept = 0;
  [[nodiscard]] virtual const Twist& trueTwist() const noexcept = 0;
};

}  // namespace vps::device
