// SPDX-License-Identifier: BSD-3-Clause
// What a trade has time for.
#pragma once

#include <chrono>

#include "vps_scenes/trade.h"

namespace vps::scenes {

/// Expects what a setting will take from what the scene's own took, and keeps the time that is left. Planning
/// is by the clock: which rows there are depends on it, what they hold does not.
class TradePlan {
 public:
  TradePlan(const TradeOptions& options, const Fidelity& own);

  [[nodiscard]] double spent_s() const;
  /// Keeps room for the suggestion, which comes last.
  [[nodiscard]] double left_s() const;

  /// True if there is time to build and ask a setting's models; for the reference, to run it too.
  [[nodiscard]] bool hasTimeForModels(const TradeTry& what) const;
  [[nodiscard]] bool hasTimeForRun(const TradeTry& what) const;

  /// What the scene's own setting took, by which all others are expected.
  void ownModelsTook(double wall_s) { own_models_s_ = wall_s; }
  void ownProbeTook(double wall_s) { own_probe_s_ = wall_s; }
  void runTook(const TradeTry& what, double wall_s);
  /// What follows is the last.
  void goLast() { is_last_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  /// How much more than the scene's own a setting is expected to take.
  [[nodiscard]] double modelShare(const TradeTry& what) const;
  [[nodiscard]] double runShare(const TradeTry& what) const;
  [[nodiscard]] double probe_s(const TradeTry& what) const;
  [[nodiscard]] double run_s(const TradeTry& what) const;

  Clock::time_point begun_;
  double seconds_;
  bool is_thorough_;
  Fidelity own_;
  double own_models_s_ = 0, own_run_s_ = 0, own_probe_s_ = 0;
  double run_scale_ = 1;  ///< what runs took by what they were expected to, the latest
  int runs_ = 0;
  bool is_last_ = false;
};

}  // namespace vps::scenes
