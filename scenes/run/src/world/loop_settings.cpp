// SPDX-License-Identifier: BSD-3-Clause
#include "world/loop_settings.h"

#include <cmath>

#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/gains.h"

namespace vps::scenes {

device::LoopSettings loopSettings(const Scene& scene, const device::Device& device, double delay_s) {
  const device::DeviceLimits limits = device.limits();
  device::LoopSettings settings;
  settings.gains = passiveGains(scene, limits, scene.fidelity.physics_rate_hz, delay_s);
  const CouplingWishes& wishes = scene.coupling;
  settings.gains.k_N_per_m = wishes.k_N_per_m.value_or(settings.gains.k_N_per_m);
  settings.gains.b_Ns_per_m = wishes.b_Ns_per_m.value_or(settings.gains.b_Ns_per_m);
  settings.gains.k_Nm_per_rad = wishes.k_Nm_per_rad.value_or(settings.gains.k_Nm_per_rad);
  settings.gains.b_Nms_per_rad = wishes.b_Nms_per_rad.value_or(settings.gains.b_Nms_per_rad);
  settings.gains.max_force_N = wishes.max_force_N.value_or(settings.gains.max_force_N);
  settings.gains.max_torque_Nm = wishes.max_torque_Nm.value_or(settings.gains.max_torque_Nm);
  settings.map.scale = scene.device.scale;
  const device::DeviceKind* kind = device::findDeviceKind(scene.device.kind);
  if (scene.device.placement) {
    settings.map.X_WD = *scene.device.placement;
    settings.is_collocated = kind != nullptr && !kind->isSimulated();
  }
  settings.safety.force_N = limits.peak_force_N;
  settings.safety.torque_Nm = limits.peak_torque_Nm;
  settings.period_s = 1 / scene.fidelity.haptic_rate_hz;
  // A part in free motion is one physics step behind the proxy. Without extrapolation the hand would feel a
  // drag of k v dt, 0.4 N at 0.35 m/s.
  settings.extrapolates_part = true;
  return settings;
}

CouplingGains passiveGains(const Scene& scene, const device::DeviceLimits& limits, double physics_rate_hz,
                           double delay_s) {
  device::CouplingTiming timing;
  timing.haptic_rate_hz = scene.fidelity.haptic_rate_hz;
  timing.physics_rate_hz = physics_rate_hz;
  timing.scale = scene.device.scale;
  timing.delay_s = delay_s;
  return device::deriveGains(limits, timing);
}

int ticksPerStep(const Scene& scene) {
  const double ratio = scene.fidelity.haptic_rate_hz / scene.fidelity.physics_rate_hz;
  const int ticks = static_cast<int>(std::lround(ratio));
  if (ticks < 1 || std::abs(ratio - ticks) > 1e-9)
    throw LoadError(scene.file, "",
                    "the haptic rate is not a whole multiple of the physics rate; choose, say, 1000 Hz "
                    "for both");
  return ticks;
}

}  // namespace vps::scenes
