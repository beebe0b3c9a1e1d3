// SPDX-License-Identifier: BSD-3-Clause
// The settings that a trade study measures, its Pareto front, and its time budget.
#pragma once

#include <chrono>
#include <vector>

#include "vps_scenes/planning/trade.h"

namespace vps::scenes {

/// The settings to measure: the scene's own fidelity; each setting alone coarser and finer, the most
/// informative setting first; and all settings together coarser and finer.
std::vector<TradeSetting> tradeDesign(const Scene& scene);

/// References to compare the other rows with, the best reference first: half the lengths, twice the rates and
/// four times the solver iterations; then, for less run time, the same with the scene's own rates; then, for
/// still less run time, with 0.7 of the lengths.
std::vector<TradeSetting> tradeReferences(const Scene& scene);

/// Combines, for each setting, the cheapest row whose error is at most a tenth above that of the scene's own
/// fidelity. The name is empty if fewer than two settings change.
TradeSetting tradeSuggestion(const Scene& scene, const std::vector<TradeRow>& rows);

/// Marks the completed rows that no other completed row dominates in step time (99th percentile of processor
/// time), error and memory. The reference is treated as any other row.
void markFront(std::vector<TradeRow>& rows);

/// Estimates the time of a setting from the times of the scene's own setting, and tracks the remaining time.
/// The times decide which rows are measured, but not the contents of a row.
class TradePlan {
 public:
  TradePlan(const TradeOptions& options, const Fidelity& own);

  [[nodiscard]] double spent_s() const;
  /// Remaining time, minus a reserve for the suggestion, which is measured last.
  [[nodiscard]] double left_s() const;

  /// True if there is time to build and probe a setting's models; for a reference, also time to run the
  /// scene.
  [[nodiscard]] bool hasTimeForModels(const TradeSetting& setting) const;
  [[nodiscard]] bool hasTimeForRun(const TradeSetting& setting) const;

  /// Records the times of the scene's own setting, from which the times of other settings are estimated.
  void ownModelsTook(double wall_s) { own_models_s_ = wall_s; }
  void ownProbeTook(double wall_s) { own_probe_s_ = wall_s; }
  void runTook(const TradeSetting& setting, double wall_s);
  /// Makes the reserved time available.
  void releaseReserve() { is_reserve_released_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Estimated time of a setting, relative to the time of the scene's own setting.
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
