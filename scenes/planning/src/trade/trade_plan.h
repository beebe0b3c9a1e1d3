// SPDX-License-Identifier: BSD-3-Clause
// The time budget of a trade study.
#pragma once

#include <chrono>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// Estimates the time of a setting from the times of the scene's own setting, and tracks the remaining time.
/// The times decide which rows are measured, but not the contents of a row.
class TradePlan {
 public:
  TradePlan(const TradeOptions& options, const Fidelity& own);

  [[nodiscard]] double spent_s() const;
  /// Remaining time, minus a reserve for the suggestion, which is measured last.
  [[nodiscard]] double left_s() const;

  /// True if there is time to build and probe a setting's models; for a reference, also to run it.
  [[nodiscard]] bool hasTimeForModels(const TradeSetting& setting) const;
  [[nodiscard]] bool hasTimeForRun(const TradeSetting& setting) const;

  /// Records the times of the scene's own setting, from which the others are estimated.
  void ownModelsTook(double wall_s) { own_models_s_ = wall_s; }
  void ownProbeTook(double wall_s) { own_probe_s_ = wall_s; }
  void runTook(const TradeSetting& setting, double wall_s);
  /// Makes the reserved time available.
  void releaseReserve() { is_reserve_released_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Estimated time of a setting, relative to the scene's own.
  [[nodiscard]] double modelShare(const TradeSetting& setting) const;
  [[nodiscard]] double runShare(const TradeSetting& setting) const;
  [[nodiscard]] double probe_s(const TradeSetting& setting) const;
  [[nodiscard]] double run_s(const TradeSetting& setting) const;

  Clock::time_point begun_;
  double seconds_;
  bool is_thorough_;
  Fidelity own_;
  double own_models_s_ = 0, own_run_s_ = 0, own_probe_s_ = 0;
  double run_scale_ = 1;  ///< ratio of measured to estimated run time, smoothed
  int runs_ = 0;
  bool is_reserve_released_ = false;
};

}  // namespace vps::scenes
