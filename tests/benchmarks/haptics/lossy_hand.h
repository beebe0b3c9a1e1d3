// SPDX-License-Identifier: BSD-3-Clause
// A scene's simulated hand behind a connection with delay and packet loss, and the true energy balance at the
// handle, computed from the plant.
#pragma once

#include <array>
#include <memory>

#include "haptics/hand.h"
#include "vps_bullet/shape.h"
#include "vps_device/dual_arm/simulated_dual_arm.h"
#include "vps_device/random.h"

namespace vps::bench {

struct Connection {
  int delay_ticks = 0;  ///< delay of wrenches, in addition to the arm's own delay
  double lost = 0;      ///< share of samples and wrenches that are lost; the last one that arrived is used
  std::uint64_t seed = 1;
};

/// The device at the far end of the connection. The limits of the device include the delay, so that the gains
/// allow for it.
class LossyDevice final : public device::Device {
 public:
  /// `inner` must outlive this object.
  LossyDevice(device::Device& inner, const Connection& connection)
      : inner_(&inner), connection_(connection), random_(connection.seed) {}
  device::DeviceSample read() noexcept override;
  void write(const Wrench& F) noexcept override;
  void rearm() noexcept override { inner_->rearm(); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return inner_->name(); }

 private:
  device::Device* inner_;
  Connection connection_;
  device::Random random_;
  device::DeviceSample arrived_;
  bool has_sample_ = false;
  std::array<Wrench, 16> sent_{};  // newest first
  Wrench held_;
};

/// The energy balance of PassivityObserver, from true poses and the forces that actually act. The only
/// dissipation of the device that counts is the arm's stated least damping; its dry friction is a margin.
struct TrueEnergyBalance {
  double balance_J = 0, least_J = 0, injected_J = 0;
  void update(double now_J);
};

/// Runs the scene's own hand over this connection. The simulated arm takes four steps per tick (see
/// pressOnWall() in tests/support/device/sampled_wall.h).
class LossyHand final : public scenes::Hand {
 public:
  LossyHand(const scenes::Scene& scene, const Connection& connection);

  device::Device& device() override { return device_; }
  void prepare(const device::OperatorTask& task, std::size_t step, double now_s) override;
  void begin() override;
  void goBack(std::size_t next) override;
  void recentre() override { hand_->recentre(); }
  void goOn() override { hand_->goOn(); }
  void step(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) override;
  [[nodiscard]] device::OperatorPhase phase() const override { return hand_->phase(); }
  [[nodiscard]] device::OperatorStrategy strategy() const override { return hand_->strategy(); }
  [[nodiscard]] bool canGoOn(int ticks) const override { return hand_->canGoOn(ticks); }

  [[nodiscard]] const TrueEnergyBalance& energy() const { return energy_; }

 private:
  [[nodiscard]] double stored_J(const device::HeldPart& part, const device::HapticLoop& loop) const;
  [[nodiscard]] Pose poseAtMotors() const;
  [[nodiscard]] Wrench actingWrench() const;

  const scenes::Scene& scene_;
  std::unique_ptr<scenes::Hand> hand_;
  device::SimulatedDualArm& arm_;
  LossyDevice device_;
  device::DeviceLimits limits_;
  TrueEnergyBalance energy_;
  /// The part that is held, or the next part.
  struct Held {
    Pose X_PG;
    bullet::BodyFrame body;
  };
  Held held_, next_;
  long ticks_per_step_, tick_ = 0;
  bool is_holding_ = false, is_new_ = false;
  double work_J_ = 0, dissipated_J_ = 0, start_J_ = 0;
};

}  // namespace vps::bench
