// SPDX-License-Identifier: BSD-3-Clause
#include "trade/trade_plan.h"

#include <algorithm>

namespace vps::scenes {

namespace {

constexpr double kSuggestionShare = 0.6;  ///< reserve for the suggestion, relative to the scene's own run
constexpr int kMinRuns = 4;               ///< least number of runs for a suggestion
constexpr double kReferenceShare = 0.4;   ///< limit for the reference, as a share of the remaining time
constexpr double kTimeMargin = 1.2;       ///< bound of the real time relative to the estimate

}  // namespace

TradePlan::TradePlan(const TradeOptions& options, const Fidelity& own)
    : begun_(Clock::now()), seconds_(options.seconds), is_thorough_(options.is_thorough), own_(own) {}

double TradePlan::spent_s() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

double TradePlan::left_s() const {
  if (is_thorough_) return 1e9;
  return seconds_ - spent_s() -
         (is_reserve_released_ || runs_ < kMinRuns ? 0 : kSuggestionShare * own_run_s_);
}

double TradePlan::modelShare(const TradeSetting& setting) const {
  // Maps and shells cover the surface, so that nodes and points grow with the inverse square of the length.
  const double h = own_.voxel_m / setting.fidelity.voxel_m, s = own_.spacing_m / setting.fidelity.spacing_m;
  return 0.5 * (h * h + s * s);
}

double TradePlan::runShare(const TradeSetting& setting) const {
  // About half of a run is spent in work that depends on the meshes alone, such as the judge; the rest grows
  // with points and rates.
  const double s = own_.spacing_m / setting.fidelity.spacing_m;
  const double rate = setting.fidelity.physics_rate_hz / own_.physics_rate_hz;
  return 0.5 + 0.5 * std::max(0.25, s * s) * rate;
}

double TradePlan::probe_s(const TradeSetting& setting) const {
  return own_models_s_ * modelShare(setting) + own_probe_s_;
}

double TradePlan::run_s(const TradeSetting& setting) const {
  return run_scale_ * own_run_s_ * runShare(setting);
}

bool TradePlan::hasTimeForModels(const TradeSetting& setting) const {
  if (setting.knob == TradeKnob::Reference)
    return probe_s(setting) + run_s(setting) <= kReferenceShare * left_s();
  return kTimeMargin * probe_s(setting) <= left_s();
}

bool TradePlan::hasTimeForRun(const TradeSetting& setting) const {
  return kTimeMargin * run_s(setting) <= left_s();
}

void TradePlan::runTook(const TradeSetting& setting, double wall_s) {
  ++runs_;
  if (setting.knob == TradeKnob::Own)
    own_run_s_ = wall_s;
  else
    run_scale_ = 0.5 * (run_scale_ + wall_s / (own_run_s_ * runShare(setting)));
}

}  // namespace vps::scenes
