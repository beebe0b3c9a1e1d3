// SPDX-License-Identifier: BSD-3-Clause
// A scene's simulated hand behind a poor line: delay, lost packets. And a ledger of the energy that truly
// passes the handle, kept from the plant itself.
#pragma once

#include <array>
#include <memory>

#include "haptics/hand.h"
#include "vps_bullet/shape.h"
#include "vps_device/random.h"
#include "vps_device/simulated_dual_arm.h"

namespace vps::bench {

struct Line {
  int delay_ticks = 0;  ///< of wrenches, on top of the arm's own
  double lost = 0;      ///< share of samples and of wrenches that never arrive; the one before stands
  std::uint64_t seed = 1;
};

/// The device at the far end of the line. States the line's delay in its limits, so that gains reckon with
/// it.
class LossyDevice final : public device::Device {
 public:
  /// inner outlives it.
  LossyDevice(device::Device& inner, const Line& line) : inner_(&inner), line_(line), random_(line.seed) {}
  device::DeviceSample read() noexcept override;
  void write(const Wrench& F) noexcept override;
  void rearm() noexcept override { inner_->rearm(); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return inner_->name(); }

 private:
  device::Device* inner_;
  Line line_;
  device::Random random_;
  device::DeviceSample arrived_;
  bool has_sample_ = false;
  std::array<Wrench, 16> sent_{};  // newest first
  Wrench held_;
};

/// DESIGN section 7's balance, of true places and of the forces that truly act; PassivityObserver says what
/// the rise of it bounds. Device dissipation is the arm's stated least damping alone: its dry friction is to
/// the hand's good.
struct TrueLedger {
  double balance_J = 0, least_J = 0, injected_J = 0;
  void draw(double now_J);
};

/// Runs the scene's own hand over that line, its plant in four steps a tick (see tests/support/wall_press.h).
class LossyHand final : public scenes::Hand {
 public:
  LossyHand(const scenes::Scene& scene, const Line& line);

  device::Device& device() override { return device_; }
  void prepare(const device::OperatorTask& task, std::size_t step, double now_s) override;
  void begin() override;
  void goBack(std::size_t next) override;
  void recentre() override { hand_->recentre(); }
  void goOn() override { hand_->goOn(); }
  void step(const scenes::HeldPart& part, const device::HapticLoop& loop, double dt_s) override;
  [[nodiscard]] device::OperatorPhase phase() const override { return hand_->phase(); }
  [[nodiscard]] bool canGoOn(int ticks) const override { return hand_->canGoOn(ticks); }

  [[nodiscard]] const TrueLedger& ledger() const { return ledger_; }

 private:
  [[nodiscard]] double stored_J(const scenes::HeldPart& part, const device::HapticLoop& loop) const;
  [[nodiscard]] Pose atTheMotors() const;
  [[nodiscard]] Wrench acting() const;

  const scenes::Scene& scene_;
  std::unique_ptr<scenes::Hand> hand_;
  device::SimulatedDualArm& arm_;
  LossyDevice device_;
  device::DeviceLimits limits_;
  TrueLedger ledger_;
  /// What is held, and what is to be held next.
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
