// SPDX-License-Identifier: BSD-3-Clause
// The dual arm in simulated time: the controller that hardware would have, driving the plant that stands for
// it.
#pragma once

#include "vps_device/dual_arm_controller.h"
#include "vps_device/dual_arm_plant.h"
#include "vps_device/export.h"

namespace vps::device {

struct SimulatedDualArmSettings {
  DualArmParameters arms;
  bool has_quantised_encoders = true;  ///< false: exact readings, without noise too
  bool is_rigid = false;               ///< true: nothing bends
  double rate_hz = 1000;               ///< of read-write cycles
  std::uint64_t seed = 1;              ///< of the encoders' noise
  Pose X_DH_start;
};

/// Nothing that the plant itself does not have: exact readings, a rigid structure, no delay. To tell their
/// share.
VPS_DEVICE_API SimulatedDualArmSettings idealDualArm();

/// Deterministic; nothing allocates after construction.
class VPS_DEVICE_API SimulatedDualArm final : public Device {
 public:
  explicit SimulatedDualArm(const SimulatedDualArmSettings& settings = {});
  SimulatedDualArm(const SimulatedDualArm&) = delete;
  SimulatedDualArm& operator=(const SimulatedDualArm&) = delete;

  DeviceSample read() noexcept override { return controller_.read(); }
  void write(const Wrench& F_Ho_D) noexcept override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return controller_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return controller_.name(); }
  void rearm() noexcept override { controller_.rearm(); }

  /// Advances the plant by dt_s with the hand `hand` (in D) on the handle; see DualArmPlant::step().
  void step(double dt_s, const HandForce& hand) noexcept { plant_.step(dt_s, hand); }

  /// Puts the handle elsewhere, at rest; the next read() starts afresh. For calibration and tests.
  void moveTo(const Pose& X_DH) noexcept;

  /// The truth, for tests and for the operator's own senses; the loop sees only read().
  [[nodiscard]] const Pose& truePose() const noexcept { return plant_.pose(); }
  [[nodiscard]] const Twist& trueTwist() const noexcept { return plant_.twist(); }
  [[nodiscard]] double time_s() const noexcept { return plant_.time_s(); }
  /// What the motors were last told to give to the hand, after limits, less the handle's weight, in D.
  [[nodiscard]] const Wrench& appliedWrench() const noexcept { return F_applied_; }
  [[nodiscard]] const Wrench& lastHandWrench() const noexcept { return plant_.lastHandWrench(); }
  [[nodiscard]] double kinetic_J() const noexcept { return plant_.kinetic_J(); }
  [[nodiscard]] double structure_J() const noexcept { return plant_.structure_J(); }
  [[nodiscard]] double friction_J() const noexcept { return plant_.friction_J(); }
  [[nodiscard]] unsigned long saturatedWrites() const noexcept { return controller_.saturatedWrites(); }
  [[nodiscard]] const DualArmPlant& plant() const noexcept { return plant_; }
  [[nodiscard]] DualArmController& controller() noexcept { return controller_; }
  [[nodiscard]] DeviceEventQueue& events() noexcept { return events_; }

 private:
  DeviceEventQueue events_;
  DualArmPlant plant_;
  DualArmController controller_;
  Wrench F_applied_;
};

}  // namespace vps::device
