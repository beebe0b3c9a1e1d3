// SPDX-License-Identifier: BSD-3-Clause
// The simulated dual arm, with its imperfections and without them, and both as kinds of device.
#include "vps_device/dual_arm/simulated_dual_arm.h"

#include "vps_device/device_kinds.h"
#include "vps_device/dual_arm/statics.h"

namespace vps::device {

namespace {

DualArmParameters parametersOf(const DeviceOptions& options) {
  return options.parameter_file.empty() ? DualArmParameters{}
                                        : loadDualArm(options.parameter_file).parameters;
}

std::unique_ptr<SimulatedDevice> simulateDualArm(const DeviceOptions& options) {
  SimulatedDualArmSettings settings;
  settings.arms = parametersOf(options);
  settings.has_quantised_encoders = options.has_quantised_encoders;
  settings.rate_hz = options.rate_hz;
  settings.X_DH_start = options.X_DH_start;
  return std::make_unique<SimulatedDualArm>(settings);
}

std::unique_ptr<SimulatedDevice> simulateIdealDualArm(const DeviceOptions& options) {
  SimulatedDualArmSettings settings = idealDualArm();
  settings.arms = parametersOf(options);
  settings.arms.delay_ticks = 0;
  settings.rate_hz = options.rate_hz;
  settings.X_DH_start = options.X_DH_start;
  return std::make_unique<SimulatedDualArm>(settings);
}

std::string nothing() {
  return "";
}

}  // namespace

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

DeviceKind dualArmKind() {
  return {"dual_arm", "simulated dual arm, moved by the virtual operator", "", nullptr, simulateDualArm,
          nothing};
}

DeviceKind idealDualArmKind() {
  return {"ideal_dual_arm",
          "simulated dual arm with exact encoders, a rigid structure and no delay",
          "",
          nullptr,
          simulateIdealDualArm,
          nothing};
}

}  // namespace vps::device
