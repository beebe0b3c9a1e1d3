// SPDX-License-Identifier: BSD-3-Clause
// Events of a device for its user: faults, warnings and notices, to be shown and sounded by a viewer.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

enum class DeviceEventKind : std::uint8_t {
  // Faults: no wrench until rearm().
  BadEncoder,   ///< a reading is not finite
  EncoderJump,  ///< a gimbal centre jumped [m]
  PulledApart,  ///< the gimbal centres' distance differs from L [m]
  LeftArmLost,
  RightArmLost,
  ClockBackwards,  ///< [s]
  Silent,          ///< nothing new from the hardware [s]
  SharpMotion,     ///< too fast [m/s or rad/s]
  PeerLost,        ///< no wrench was written in time [s]
  BadForce,        ///< the loop's force is not finite
  BadPose,         ///< the device's pose is not finite
  PoseJump,        ///< the device's pose jumped
  DeviceLost,      ///< the device reports that it is lost
  BadGains,        ///< no loop can run with these coupling gains
  PhysicsStalled,  ///< no new state of the part in hand [s]
  NotCalibrated,
  // Warnings: the device continues.
  BadWrench,     ///< the commanded wrench is not finite and counts as zero
  Saturated,     ///< the motors cannot give the commanded wrench [share given]
  MotorHot,      ///< the peak effort begins to decrease [heat, 1 is the limit]
  NearStop,      ///< a joint is near its stop [joint: 0 to 6, 7 is q2]
  NearSingular,  ///< the gimbal is near its singularity [q2, rad]
  ArmsNear,      ///< the arms are close to each other [m]
  TicksMissed,   ///< the loop missed periods [periods]
  NoPriority,    ///< the system refuses real-time priority
  NotLocked,     ///< the system refuses to lock the program's memory
  // Notices.
  Calibrated,
  Rearmed,
};

enum class Severity : std::uint8_t { Notice, Warning, Fault };

VPS_DEVICE_API Severity severityOf(DeviceEventKind kind) noexcept;
/// A few words for a person: "an arm's reading jumped".
VPS_DEVICE_API const char* toText(DeviceEventKind kind) noexcept;
/// The remedy: "check the encoder's cable, then re-arm".
VPS_DEVICE_API const char* remedyOf(DeviceEventKind kind) noexcept;
/// Its sound: pitch [Hz] and number of beeps; 0 beeps for a notice. assumed: an octave between warning and
/// fault, both where hearing is most sensitive.
struct Beep {
  double pitch_hz = 0;
  int count = 0;
};
VPS_DEVICE_API Beep beepOf(DeviceEventKind kind) noexcept;

struct DeviceEvent {
  double time_s = 0;
  DeviceEventKind kind = DeviceEventKind::Rearmed;
  double value = 0;  ///< the quantity in brackets at the kind
};

/// From the haptic thread to one reader; neither waits. A full queue keeps the older events, which show where
/// a problem began, and counts those it refuses.
class VPS_DEVICE_API DeviceEventQueue {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// Haptic thread. False if the queue is full.
  bool push(const DeviceEvent& event) noexcept;
  /// Reader. False if the queue is empty.
  bool pop(DeviceEvent& event) noexcept;
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<DeviceEvent, kCapacity> events_{};
  std::atomic<std::size_t> pushed_{0}, popped_{0};
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace vps::device
