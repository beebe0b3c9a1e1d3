// SPDX-License-Identifier: BSD-3-Clause
#include "trade/plan.h"

#include <algorithm>

namespace vps::scenes {

namespace {

constexpr double kSuggestionShare = 0.6;  ///< of the scene's own run, kept for what comes last
constexpr int kFewRuns = 4;               ///< with fewer there is nothing to suggest from
constexpr double kReferenceShare = 0.4;   ///< of the time left, that the reference may take
constexpr double kInHand = 1.2;           ///< what is expected is no more than that

}  // namespace

TradePlan::TradePlan(const TradeOptions& options, const Fidelity& own)
    : begun_(Clock::now()), seconds_(options.seconds), is_thorough_(options.is_thorough), own_(own) {}

double TradePlan::spent_s() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

double TradePlan::left_s() const {
  if (is_thorough_) return 1e9;
  return seconds_ - spent_s() - (is_last_ || runs_ < kFewRuns ? 0 : kSuggestionShare * own_run_s_);
}

double TradePlan::modelShare(const TradeTry& what) const {
  // Maps and shells follow the surface: their number of nodes and points goes with the inverse square.
  const double h = own_.voxel_m / what.fidelity.voxel_m, s = own_.spacing_m / what.fidelity.spacing_m;
  return 0.5 * (h * h + s * s);
}

double TradePlan::runShare(const TradeTry& what) const {
  // Half of a run is the judge and what follows the meshes alone; the rest goes with points and rates.
  const double s = own_.spacing_m / what.fidelity.spacing_m;
  const double rate = what.fidelity.physics_rate_hz / own_.physics_rate_hz;
  return 0.5 + 0.5 * std::max(0.25, s * s) * rate;
}

double TradePlan::probe_s(const TradeTry& what) const {
  return own_models_s_ * modelShare(what) + own_probe_s_;
}

double TradePlan::run_s(const TradeTry& what) const {
  return run_scale_ * own_run_s_ * runShare(what);
}

bool TradePlan::hasTimeForModels(const TradeTry& what) const {
  if (what.knob == TradeKnob::Reference) return probe_s(what) + run_s(what) <= kReferenceShare * left_s();
  return kInHand * probe_s(what) <= left_s();
}

bool TradePlan::hasTimeForRun(const TradeTry& what) const {
  return kInHand * run_s(what) <= left_s();
}

void TradePlan::runTook(const TradeTry& what, double wall_s) {
  ++runs_;
  if (what.knob == TradeKnob::Own)
    own_run_s_ = wall_s;
  else
    run_scale_ = 0.5 * (run_scale_ + wall_s / (own_run_s_ * runShare(what)));
}

}  // namespace vps::scenes
