// SPDX-License-Identifier: BSD-3-Clause
#include "load/load_governor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vps::scenes::inline v0 {

namespace {

constexpr double kMaxPeriods = 1e6;  ///< of one step: a jump of the clock must not overflow the sums

/// Periods from the beginning of a step to that of the next.
double periodsOf(double busy_s, double period_s) {
  return std::clamp(std::ceil(busy_s / period_s), 1.0, kMaxPeriods);
}

}  // namespace

LoadGovernor::LoadGovernor(std::vector<double> cost_ratios, const GovernorSettings& settings,
                           std::vector<double> speeds)
    : cost_ratios_(std::move(cost_ratios)),
      speeds_(std::move(speeds)),
      settings_(settings),
      wait_(settings.calm_windows) {
  speeds_.resize(cost_ratios_.size() + 1, speeds_.empty() ? 1 : speeds_.back());
}

int LoadGovernor::add(double busy_s, double period_s, bool may_rise) noexcept {
  if (!(busy_s > 0)) busy_s = 0;
  const double periods = periodsOf(busy_s, period_s);
  now_.elapsed_s += periods * period_s;
  now_.lost_s += (periods - 1) * period_s;
  now_.busy_s += busy_s;
  now_.late += periods > 1;
  ++now_.steps;
  if (level_ > 0) {
    const double above = periodsOf(cost_ratios_[static_cast<std::size_t>(level_ - 1)] * busy_s, period_s);
    now_.elapsed_above_s += above * period_s;
    now_.lost_above_s += (above - 1) * period_s;
    now_.late_above += above > 1;
  }
  // With steps of seconds, a window of window_s would hold too few to reach late_limit, and each would count
  // as a stall.
  const bool is_whole = now_.elapsed_s >= settings_.window_s && now_.steps >= settings_.late_limit;
  return is_whole ? decide(may_rise) : level_;
}

bool LoadGovernor::isOverloaded() const noexcept {
  return last_.late >= settings_.late_limit && last_.lostShare() > settings_.lost_limit;
}

/// True if simulated time would run faster one level down, did that level lose nothing.
bool LoadGovernor::isFasterBelow() const noexcept {
  const auto level = static_cast<std::size_t>(level_);
  return (1 - last_.lostShare()) * speeds_[level] < speeds_[level + 1];
}

int LoadGovernor::decide(bool may_rise) noexcept {
  last_ = {now_.elapsed_s, now_.lost_s, now_.busy_s / now_.steps, now_.late};
  const bool is_calm = level_ > 0 && (now_.late_above < settings_.late_limit ||
                                      now_.lost_above_s <= 0.5 * settings_.lost_limit * now_.elapsed_above_s);
  now_ = {};
  calm_ = is_calm ? std::min(calm_ + 1, settings_.most_calm_windows) : 0;
  if (isOverloaded() && level_ < lastLevel() && isFasterBelow()) {
    if (has_risen_) waitLonger();
    moveTo(level_ + 1);
  } else if (calm_ >= wait_ && may_rise) {
    has_risen_ = true;
    moveTo(level_ - 1);
  }
  return level_;
}

void LoadGovernor::stayAt(int level) noexcept {
  waitLonger();
  moveTo(level);
}

void LoadGovernor::waitLonger() noexcept {
  wait_ = std::min(2 * wait_, settings_.most_calm_windows);
  has_risen_ = false;
}

void LoadGovernor::moveTo(int level) noexcept {
  level_ = level;
  calm_ = 0;
}

}  // namespace vps::scenes::inline v0
