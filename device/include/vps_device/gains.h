// SPDX-License-Identifier: BSD-3-Clause
// Derives coupling gains from the device's limits and the loop's rates.
#pragma once

#include "vps/coupling_law.h"
#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

struct CouplingTiming {
  double haptic_rate_hz = 1000;
  double physics_rate_hz = 1000;  ///< the part's state is held for one step
  double delay_s = 0;             ///< additional transport delay: network, driver
  double scale = 1;               ///< scene metres per device metre
  double force_scale = 1;         ///< device newtons per scene newton
};

/// Delay t_d [s] of a moving part: transport, and one physics step, since the part's state that is read was
/// computed from a proxy up to one step old.
VPS_DEVICE_API double couplingDelay_s(const CouplingTiming& timing) noexcept;

/// The stiffest gains that keep the sampled coupling passive on this device, with a margin:
///   B = b / 5,   K = 0.8 min((b - B) / (T/2 + t_d), 2 b / T, 2 f_c / D)
/// with the device's own delay in t_d, per kind of motion, springs limited to the device's peak. The gains
/// are translated into the scene by the scales of `timing`. Source: [Colgate and Schenkel 1997], extended by
/// the delay t_d: a sampled spring K with damping B on a device with damping b is passive if b > K (T/2 +
/// t_d) + |B|; [Abbott and Okamura 2005] for f_c and D. Terms whose device value is not known (zero) are
/// omitted.
VPS_DEVICE_API CouplingGains deriveGains(const DeviceLimits& limits, const CouplingTiming& timing) noexcept;

/// For each gain and each spring limit, the smaller of the values of `a` and `b`.
VPS_DEVICE_API CouplingGains softerOf(const CouplingGains& a, const CouplingGains& b) noexcept;

/// True if the gains are finite, not negative, and at most 1 MN/m, 10 kN m/rad, dampers 10 kN s/m, 1 kN m
/// s/rad, springs limited to 1 kN and 1 kN m. Stability on a device is a separate matter: see deriveGains().
VPS_DEVICE_API bool areUsable(const CouplingGains& gains) noexcept;

}  // namespace vps::device
