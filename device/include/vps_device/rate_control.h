// SPDX-License-Identifier: BSD-3-Clause
// Rate control: how far a cap or stick is pushed says how fast the handle goes. For devices that spring back
// and give no force: space mice, game controllers.
#pragma once

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// What the hand does to cap or sticks, in D (x towards the person, y to the right, z up); each -1 to 1.
struct Deflection {
  Vec3 push = Vec3::Zero();
  Vec3 turn = Vec3::Zero();    ///< about D's axes, right-handed
  bool is_recentring = false;  ///< button: back to the middle while it is held
};

struct RateSettings {
  double speed_m_s = 0.08;  ///< at full deflection. assumed: across the dual arm's workspace in 5 s
  double turn_rad_s = 0.8;  ///< assumed: half a turn in 4 s
  double dead_zone =
      0.1;           ///< share of full deflection that counts as none. assumed: what worn sticks rest at
  double curve = 2;  ///< deflection beyond the dead zone to this power, so that small is fine. assumed
  double recentre_m_s = 0.2;  ///< way back to the middle; never a jump. assumed: 10 times below the guard's
  double recentre_rad_s = 1.5;
  Vec3 workspace_m = Vec3(0.4, 0.6, 0.4);  ///< about D's origin; as the dual arm's
  double rate_hz = 1000;                   ///< of the loop that reads
};

/// Deflections to a handle's pose. A pure function of its calls: same calls, same bits. Nothing allocates.
class VPS_DEVICE_API RateControl {
 public:
  explicit RateControl(const RateSettings& settings = {}) : settings_(settings) {}

  /// The handle at time now_s. Time that stands still or goes back moves nothing; a gap counts as 50 ms at
  /// most, so that a late reader sees no jump. A deflection that is not finite counts as none.
  const DeviceSample& step(const Deflection& deflection, double now_s) noexcept;
  /// Zero force, zero damping: nothing is felt, and nothing is known of it.
  [[nodiscard]] DeviceLimits limits() const noexcept;

 private:
  RateSettings settings_;
  DeviceSample sample_;
  bool has_time_ = false;
};

/// The share of full speed for a deflection from -1 to 1: zero within the dead zone, continuous at its edge,
/// 1 at 1, odd.
VPS_DEVICE_API double rateShare(double deflection, const RateSettings& settings) noexcept;

}  // namespace vps::device
