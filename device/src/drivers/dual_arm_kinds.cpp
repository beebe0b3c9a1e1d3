// SPDX-License-Identifier: BSD-3-Clause
// The simulated dual arm as a kind of device, and the same without its imperfections.
#include "drivers/kinds.h"
#include "vps_device/dual_arm/simulated_dual_arm.h"

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

DeviceKind dualArmKind() {
  return {"dual_arm", "simulated dual arm, moved by the virtual operator", "", nullptr, simulateDualArm,
          nothing};
}

DeviceKind idealDualArmKind() {
  return {"ideal_dual_arm",
          "the same with exact encoders, a rigid structure and no delay",
          "",
          nullptr,
          simulateIdealDualArm,
          nothing};
}

}  // namespace vps::device
