// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/gains.h"

#include <algorithm>

namespace vps::device {
namespace {

constexpr double kMargin = 0.8;  // share of the passive stiffness, since the device's numbers are estimates
constexpr double kDampingShare = 0.2;  // share of the device's damping; a greater share reduces the stiffness

struct Spring {
  double k = 0, b = 0;
};

Spring stiffest(double device_b, double coulomb, double resolution, double period_s, double delay_s,
                Spring fallback) {
  if (device_b <= 0) return fallback;
  const double b = kDampingShare * device_b;
  double k = std::min((device_b - b) / (0.5 * period_s + delay_s), 2 * device_b / period_s);
  if (coulomb > 0 && resolution > 0) k = std::min(k, 2 * coulomb / resolution);
  return {kMargin * k, b};
}

}  // namespace

double couplingDelay_s(const CouplingTiming& timing) noexcept {
  return timing.delay_s + 1 / timing.physics_rate_hz;
}

CouplingGains deriveGains(const DeviceLimits& limits, const CouplingTiming& timing) noexcept {
  const CouplingGains unknown;
  const double period_s = 1 / timing.haptic_rate_hz, delay_s = couplingDelay_s(timing) + limits.delay_s;
  const Spring line = stiffest(limits.damping_Ns_per_m, limits.coulomb_N, limits.resolution_m, period_s,
                               delay_s, {unknown.k_N_per_m, unknown.b_Ns_per_m});
  const Spring turn = stiffest(limits.damping_Nms_per_rad, limits.coulomb_Nm, limits.resolution_rad, period_s,
                               delay_s, {unknown.k_Nm_per_rad, unknown.b_Nms_per_rad});
  // A handle displacement d is scale * d in the scene; a force f in the scene is force_scale * f at the
  // handle.
  const double line_scale = 1 / (timing.scale * timing.force_scale), turn_scale = 1 / timing.force_scale;
  CouplingGains gains;
  gains.k_N_per_m = line.k * line_scale;
  gains.b_Ns_per_m = line.b * line_scale;
  gains.k_Nm_per_rad = turn.k * turn_scale;
  gains.b_Nms_per_rad = turn.b * turn_scale;
  if (limits.peak_force_N > 0) gains.max_force_N = limits.peak_force_N / timing.force_scale;
  if (limits.peak_torque_Nm > 0) gains.max_torque_Nm = limits.peak_torque_Nm / timing.force_scale;
  return gains;
}

CouplingGains softerOf(const CouplingGains& a, const CouplingGains& b) noexcept {
  return {std::min(a.k_N_per_m, b.k_N_per_m),       std::min(a.b_Ns_per_m, b.b_Ns_per_m),
          std::min(a.k_Nm_per_rad, b.k_Nm_per_rad), std::min(a.b_Nms_per_rad, b.b_Nms_per_rad),
          std::min(a.max_force_N, b.max_force_N),   std::min(a.max_torque_Nm, b.max_torque_Nm)};
}

bool areUsable(const CouplingGains& gains) noexcept {
  const auto isWithin = [](double value, double most) {
    return value >= 0 && value <= most;
  };  // false for NaN
  return isWithin(gains.k_N_per_m, 1e6) && isWithin(gains.b_Ns_per_m, 1e4) &&
         isWithin(gains.k_Nm_per_rad, 1e4) && isWithin(gains.b_Nms_per_rad, 1e3) &&
         isWithin(gains.max_force_N, 1e3) && isWithin(gains.max_torque_Nm, 1e3);
}

}  // namespace vps::device
