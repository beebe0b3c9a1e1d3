// SPDX-License-Identifier: BSD-3-Clause
// The dual arm in simulated time: the controller that hardware would have, driving the plant instead.
#pragma once

#include "vps_device/dual_arm/controller.h"
#include "vps_device/dual_arm/plant.h"
#include "vps_device/export.h"
#include "vps_device/simulated_device.h"

namespace vps::device {

struct SimulatedDualArmSettings {
  DualArmParameters arms;
  bool has_quantised_encoders = true;  ///< false: exact readings, without noise
  bool is_rigid = false;               ///< true: no elasticity
  double rate_hz = 1000;               ///< rate of read-write cycles
  std::uint64_t seed = 1;              ///< seed of the encoders' noise
  Pose X_DH_start;
};

/// Settings with exact readings, a rigid structure and no delay, to measure the effect of these
/// imperfections.
VPS_DEVICE_API SimulatedDualArmSettings idealDualArm();

/// Deterministic; nothing allocates after construction.
class VPS_DEVICE_API SimulatedDualArm final : public SimulatedDevice {
 public:
  explicit SimulatedDualArm(const SimulatedDualArmSettings& settings = {});
  SimulatedDualArm(const SimulatedDualArm&) = delete;
  SimulatedDualArm& operator=(const SimulatedDualArm&) = delete;

  DeviceSample read() noexcept override { return controller_.read(); }
  void write(const Wrench& F_Ho_D) noexcept override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return controller_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return controller_.name(); }
  void rearm() noexcept override { controller_.rearm(); }

  /// See DualArmPlant::step().
  void step(double dt_s, const HandForce& hand) noexcept override { plant_.step(dt_s, hand); }

  /// Puts the handle at X_DH, at rest, and clears the controller's state. For calibration and tests.
  void moveTo(const Pose& X_DH) noexcept;

  [[nodiscard]] const Pose& truePose() const noexcept override { return plant_.pose(); }
  [[nodiscard]] const Twist& trueTwist() const noexcept override { return plant_.twist(); }
  [[nodiscard]] double time_s() const noexcept { return plant_.time_s(); }
  /// The wrench on the hand that the last motor command gives, after limits, less the handle's weight, in D.
  [[nodiscard]] const Wrench& appliedWrench() const noexcept { return F_applied_; }
  [[nodiscard]] const Wrench& lastHandWrench() const noexcept { return plant_.lastHandWrench(); }
  [[nodiscard]] double kinetic_J() const noexcept { return plant_.kinetic_J(); }
  [[nodiscard]] double structure_J() const noexcept { return plant_.structure_J(); }
  [[nodiscard]] double friction_J() const noexcept { return plant_.friction_J(); }
  [[nodiscard]] unsigned long saturatedWrites() const noexcept { return controller_.saturatedWrites(); }
  [[nodiscard]] const DualArmPlant& plant() const noexcept { return plant_; }
  [[nodiscard]] DualArmController& controller() noexcept { return controller_; }
  [[nodiscard]] DeviceEventQueue& events() noexcept { return events_; }
  [[nodiscard]] DeviceEventQueue* ownEvents() noexcept override { return &events_; }

 private:
  DeviceEventQueue events_;
  DualArmPlant plant_;
  DualArmController controller_;
  Wrench F_applied_;
};

}  // namespace vps::device
