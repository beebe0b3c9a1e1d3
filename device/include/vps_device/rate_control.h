// SPDX-License-Identifier: BSD-3-Clause
// Rate control: the deflection of a cap or stick sets the velocity of the handle. For devices that spring
// back and give no force: space mice, game controllers.
#pragma once

#include <memory>

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// Deflection of cap or sticks, in D (x towards the person, y to the right, z up); each -1 to 1.
struct Deflection {
  Vec3 push = Vec3::Zero();
  Vec3 turn = Vec3::Zero();    ///< rotation about D's axes, right-handed
  bool is_recentring = false;  ///< button: the handle returns to the middle while it is pressed
};

struct RateSettings {
  double speed_m_s = 0.08;  ///< speed at full deflection. assumed: across the dual arm's workspace in 5 s
  double turn_rad_s = 0.8;  ///< assumed: half a turn in 4 s
  double dead_zone = 0.1;   ///< share of full deflection that counts as none. assumed: where worn sticks rest
  double curve = 2;         ///< exponent of the deflection beyond the dead zone, for fine control. assumed
  /// Speed of the return to the middle. assumed: a tenth of the guard's jump limit
  double recentre_m_s = 0.2;
  double recentre_rad_s = 1.5;
  Vec3 workspace_m = Vec3(0.4, 0.6, 0.4);  ///< box about D's origin, of the dual arm's size
  double rate_hz = 1000;                   ///< rate of the loop that reads the device
};

/// Integrates deflections to a handle's pose. Deterministic: the same calls give the same bits. Nothing
/// allocates.
class VPS_DEVICE_API RateControl {
 public:
  explicit RateControl(const RateSettings& settings = {}) : settings_(settings) {}

  /// The handle at time now_s. Without progress of time the handle does not move; a gap counts as at most 50
  /// ms, so that a late reader sees no jump. A deflection that is not finite counts as none.
  const DeviceSample& step(const Deflection& deflection, double now_s) noexcept;
  /// Zero force; damping is not known (zero).
  [[nodiscard]] DeviceLimits limits() const noexcept;

 private:
  RateSettings settings_;
  DeviceSample sample_;
  bool has_time_ = false;
};

/// The share of full speed for a deflection from -1 to 1: zero within the dead zone, continuous at its edge,
/// 1 at 1, odd.
VPS_DEVICE_API double rateShare(double deflection, const RateSettings& settings) noexcept;

/// Space mouse and game controller. A thread of the device's own calls the library, which may wait, allocate
/// and search for hardware; the haptic thread reads the latest deflection from a TripleBuffer. A device that
/// is absent or unplugged reads as lost (Status::Fault), and the thread searches for the device again; once
/// the device is back, the handle continues where it stood. The safety guard needs rearm() once the device is
/// back, as after every loss of a device.

/// The first space mouse of the spacenavd daemon (socket: SPNAV_SOCKET, /etc/spnavrc or /var/run/spnav.sock).
/// Button 0 re-centres. Throws LoadError if this build lacks libspnav, or while another space mouse device
/// exists: the library supports one connection per program.
VPS_DEVICE_API std::unique_ptr<Device> openSpaceMouse(const RateSettings& settings = {});

/// The first game controller that SDL finds. Left stick: sideways, and towards or away from the person;
/// triggers: up (right) and down; right stick: rotation about z and y; shoulders: about x; start: re-centres.
/// Throws LoadError if this build lacks SDL2.
VPS_DEVICE_API std::unique_ptr<Device> openGameController(const RateSettings& settings = {});

}  // namespace vps::device
