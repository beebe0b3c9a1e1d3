// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/simulated_dual_arm.h"

#include "dual_arm/gravity.h"

namespace vps::device {

SimulatedDualArmSettings idealDualArm() {
  SimulatedDualArmSettings settings;
  settings.has_quantised_encoders = false;
  settings.is_rigid = true;
  settings.arms.delay_ticks = 0;
  return settings;
}

SimulatedDualArm::SimulatedDualArm(const SimulatedDualArmSettings& settings)
    : plant_({settings.arms, settings.has_quantised_encoders, settings.is_rigid, settings.seed,
              settings.X_DH_start}),
      controller_(
          plant_,
          {settings.arms, settings.rate_hz, settings.has_quantised_encoders, settings.is_rigid, false},
          &events_) {}

void SimulatedDualArm::moveTo(const Pose& X_DH) noexcept {
  plant_.moveTo(X_DH);
  controller_.rearm();
}

void SimulatedDualArm::write(const Wrench& F_Ho_D) noexcept {
  controller_.write(F_Ho_D);
  const DualArmParameters& p = plant_.settings().arms;
  if (handleWrench(p, plant_.pose(), controller_.efforts(), F_applied_) == Status::Ok)
    F_applied_ += handleWeight(p);
}

}  // namespace vps::device
