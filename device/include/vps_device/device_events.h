// SPDX-License-Identifier: BSD-3-Clause
// What a device has to say to a person: faults, warnings and notices, for others to show and sound.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

enum class DeviceEventKind : std::uint8_t {
  // Faults: no wrench until re-armed.
  BadEncoder,   ///< a reading is not finite
  EncoderJump,  ///< a gimbal centre jumped [m]
  PulledApart,  ///< the gimbal centres are not L apart [m off]
  LeftArmLost,
  RightArmLost,
  ClockBackwards,  ///< [s]
  Silent,          ///< nothing new from the hardware [s]
  SharpMotion,     ///< too fast [m/s or rad/s]
  PeerLost,        ///< no wrench was asked for in time [s]
  BadForce,        ///< the loop's own force is not finite
  BadPose,         ///< the device's pose is not finite
  PoseJump,        ///< the device's pose jumped
  DeviceLost,      ///< the device says that it is lost
  BadGains,        ///< no loop can run with these coupling gains
  PhysicsStalled,  ///< nothing new of the part in hand [s]
  NotCalibrated,
  // Warnings: it goes on, but look.
  BadWrench,     ///< the wrench asked for is not finite and counts as zero
  Saturated,     ///< more was asked for than the motors give [share given]
  MotorHot,      ///< the peak begins to fade [heat, 1 is full]
  NearStop,      ///< a joint nears its stop [joint: 0 to 6, 7 is q2]
  NearSingular,  ///< the gimbal nears its singularity [q2, rad]
  ArmsNear,      ///< the arms come near each other [m]
  TicksMissed,   ///< the loop came too late for some periods [periods]
  NoPriority,    ///< the system does not let the loop go before other programs
  NotLocked,     ///< the system does not keep the program's memory from being paged out
  // Notices.
  Calibrated,
  Rearmed,
};

enum class Severity : std::uint8_t { Notice, Warning, Fault };

VPS_DEVICE_API Severity severityOf(DeviceEventKind kind) noexcept;
/// A few words for a person: "an arm's reading jumped".
VPS_DEVICE_API const char* toText(DeviceEventKind kind) noexcept;
/// What would help: "check the encoder's cable, then re-arm".
VPS_DEVICE_API const char* remedyOf(DeviceEventKind kind) noexcept;
/// How it sounds: a beep's pitch [Hz] and how many; 0 beeps for a notice. assumed: an octave between warning
/// and fault, both where hearing is best.
struct Beep {
  double pitch_hz = 0;
  int count = 0;
};
VPS_DEVICE_API Beep beepOf(DeviceEventKind kind) noexcept;

struct DeviceEvent {
  double time_s = 0;
  DeviceEventKind kind = DeviceEventKind::Rearmed;
  double value = 0;  ///< what the kind says in brackets
};

/// From the haptic thread to one reader: neither waits. A full queue keeps the older events, where a trouble
/// began, and counts what it turns away.
class VPS_DEVICE_API DeviceEventQueue {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// Haptic thread. False if there was no room.
  bool push(const DeviceEvent& event) noexcept;
  /// Reader. False if there is none.
  bool pop(DeviceEvent& event) noexcept;
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<DeviceEvent, kCapacity> events_{};
  std::atomic<std::size_t> pushed_{0}, popped_{0};
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace vps::device
