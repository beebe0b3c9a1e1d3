// SPDX-License-Identifier: BSD-3-Clause
// Interface of a haptic device: a handle whose pose is read and to which a wrench is written; and the events
// that a device reports to its user.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "vps/errors.h"
#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/export.h"

namespace vps::device {

// --- Events: faults, warnings and notices, which a viewer shows and sounds

enum class DeviceEventKind : std::uint8_t {
  // Faults: the device gives no wrench until rearm().
  BadEncoder,   ///< a reading is not finite
  EncoderJump,  ///< a gimbal centre jumped [m]
  PulledApart,  ///< the gimbal centres' distance differs from L [m]
  LeftArmLost,
  RightArmLost,
  ClockBackwards,  ///< the time stamp decreased [s]
  Silent,          ///< the hardware has sent no new reading [s]
  SharpMotion,     ///< the handle moved too fast [m/s or rad/s]
  PeerLost,        ///< no wrench was written in time [s]
  BadForce,        ///< the loop's force is not finite
  BadPose,         ///< the device's pose is not finite
  PoseJump,        ///< the device's pose jumped
  DeviceLost,      ///< the device reports that it is lost
  BadGains,        ///< the coupling gains are out of range
  PhysicsStalled,  ///< no new state of the held part [s]
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
/// Short description of an event for the user: "an arm's reading jumped".
VPS_DEVICE_API const char* toText(DeviceEventKind kind) noexcept;
/// Remedy for the user: "check the encoder's cable, then re-arm".
VPS_DEVICE_API const char* remedyOf(DeviceEventKind kind) noexcept;
/// Sound of an event; a notice has none. assumed: an octave between warning and fault, both where hearing is
/// most sensitive.
struct Beep {
  double pitch_hz = 0;
  int count = 0;
};
VPS_DEVICE_API Beep beepOf(DeviceEventKind kind) noexcept;

struct DeviceEvent {
  double time_s = 0;
  DeviceEventKind kind = DeviceEventKind::Rearmed;
  double value = 0;  ///< the quantity that DeviceEventKind gives in brackets for this kind
};

/// Queue from the haptic thread to one reader; neither waits. A full queue keeps the older events, which show
/// where a problem began, and counts the events that it refuses.
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

// --- Device

/// The handle H in the device's base frame D at one instant. V_DH: velocity of H's origin, in D.
struct DeviceSample {
  Pose X_DH;
  Twist V_DH;
  double time_s = 0;
  Status status = Status::Ok;  ///< other than Ok: the pose must not be used
};

/// Capabilities of a device, from which the coupling gains are derived. Zero means that the value is not
/// known.
struct DeviceLimits {
  double continuous_force_N = 0;
  double peak_force_N = 0;
  double continuous_torque_Nm = 0;
  double peak_torque_Nm = 0;
  Vec3 workspace_min_D = Vec3::Zero();  ///< box of the handle's origin [m]
  Vec3 workspace_max_D = Vec3::Zero();
  double rate_hz = 1000;        ///< read and write cycles per second
  double delay_s = 0;           ///< delay from a reading to the effect of the wrench computed from it
  double damping_Ns_per_m = 0;  ///< least viscous damping over the workspace, handle within 30 deg
  double damping_Nms_per_rad = 0;
  double coulomb_N = 0;  ///< least dry friction over the workspace
  double coulomb_Nm = 0;
  double resolution_m = 0;  ///< greatest error of a position read
  double resolution_rad = 0;
  /// The handle reaches every rotation from the identity up to this angle, anywhere in the box [rad]; 0: any
  /// rotation.
  double workspace_rad = 0;
};

/// A 6-DOF haptic device. One thread calls read() and write() in turn; neither throws, allocates or waits.
/// Code that may throw, allocate or wait (a driver, a socket, a window) runs on a thread of its own. A new
/// device is:
///
///   class MyDevice final : public Device {
///     DeviceSample read() noexcept override { return sample_.read(); }
///     void write(const Wrench& F_Ho_D) noexcept override { wrench_.write(F_Ho_D); }
///     DeviceLimits limits() const noexcept override { return {.peak_force_N = 3}; }
///     std::string_view name() const noexcept override { return "my_device"; }
///     TripleBuffer<DeviceSample> sample_;  // vps/triple_buffer.h: the driver's thread writes it
///     TripleBuffer<Wrench> wrench_;        // and reads this one; neither thread waits
///   };
///
/// A device that may stop sending stamps its samples, and returns Fault once the last sample is too old.
/// device/DRIVERS.md tells how to make a device available to scenes by name.
class VPS_DEVICE_API Device {
 public:
  virtual ~Device() = default;

  /// The newest pose. Status other than Ok when the device is lost or singular.
  virtual DeviceSample read() noexcept = 0;

  /// Wrench on the hand about H's origin, in D, held until the next write. The device saturates the wrench
  /// and keeps its direction; a wrench that is not finite counts as zero.
  virtual void write(const Wrench& F_Ho_D) noexcept = 0;

  /// Clears a fault that the device itself has latched. The next pose may be anywhere.
  virtual void rearm() noexcept {}

  /// Queue of the events that the device itself reports, for one reader; null if it reports none.
  [[nodiscard]] virtual DeviceEventQueue* ownEvents() noexcept { return nullptr; }

  [[nodiscard]] virtual DeviceLimits limits() const noexcept = 0;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

 protected:
  Device() = default;
  Device(const Device&) = default;
  Device& operator=(const Device&) = default;
};

}  // namespace vps::device
