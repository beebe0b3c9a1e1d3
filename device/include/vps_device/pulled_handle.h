// SPDX-License-Identifier: BSD-3-Clause
// A handle that exists only in the program: a spring pulls it to a cursor, in six degrees of freedom.
#pragma once

#include <memory>

#include "vps/triple_buffer.h"
#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// The pose to which a cursor pulls the handle, from one thread to another; neither waits.
using HandleWish = TripleBuffer<Pose>;  ///< X_DH

struct PulledHandleSettings {
  double k_N_per_m = 3000;   ///< stiffness of the spring. assumed: 3 mm at the spring's greatest force
  double k_Nm_per_rad = 25;  ///< assumed: 2 degrees at the spring's greatest torque
  /// Damping of the handle by its surroundings. assumed: 0.33 m/s at the greatest force
  double b_Ns_per_m = 30;
  double b_Nms_per_rad = 0.25;  ///< assumed: 4 rad/s at the greatest torque
  double force_N = 10;    ///< greatest pull. assumed: between the virtual operator's press and its limit
  double torque_Nm = 1;   ///< greatest turn of the spring. assumed: the dual arm's continuous torque
  double rate_hz = 1000;  ///< rate of the loop that reads the handle
};

/// The handle has no inertia. Damped by its surroundings it moves under the spring and under the force on the
/// hand:  b v = pull + f,  pull = k (p_wish - p), limited. The handle therefore stands still where a part
/// meets a wall, and the pull is the force of the hand. Deterministic: the same calls give the same bits.
/// Nothing allocates.
class VPS_DEVICE_API PulledHandle {
 public:
  explicit PulledHandle(const PulledHandleSettings& settings = {}) : settings_(settings) {}

  /// The handle at time now_s, after the force on the hand since the last call was F_Ho_D. Without progress
  /// of time the handle does not move; a gap counts as at most 20 ms. Values that are not finite have no
  /// effect.
  const DeviceSample& step(const Pose& X_DH_wish, const Wrench& F_Ho_D, double now_s) noexcept;
  [[nodiscard]] DeviceLimits limits() const noexcept;

 private:
  PulledHandleSettings settings_;
  DeviceSample sample_;
  bool has_time_ = false;
};

/// The mouse as a device: a PulledHandle in real time, which a window's thread pulls through `wish`.
VPS_DEVICE_API std::unique_ptr<Device> openMouse(std::shared_ptr<HandleWish> wish,
                                                 const PulledHandleSettings& settings = {});

}  // namespace vps::device
