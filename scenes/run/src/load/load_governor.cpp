// SPDX-License-Identifier: BSD-3-Clause
#include "load/load_governor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/physics_clock.h"

namespace vps::scenes {

namespace {

constexpr double kMostPeriods =
    1e6;  ///< limit of a step's duration, so that a jump of the clock does not overflow the sums

}  // namespace

void LoadGovernor::Course::add(double busy_s, double period_s) noexcept {
  behind_s = std::max(0.0, behind_s + std::min(busy_s, kMostPeriods * period_s) - period_s);
  const double lost_periods = std::ceil((behind_s - mostLate_s(period_s)) / period_s);
  elapsed_s += period_s;
  if (!(lost_periods > 0)) return;
  behind_s -= lost_periods * period_s;
  elapsed_s += lost_periods * period_s;
  lost_s += lost_periods * period_s;
  ++late;
}

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
  now_.add(busy_s, period_s);
  if (level_ > 0) above_.add(cost_ratios_[static_cast<std::size_t>(level_ - 1)] * busy_s, period_s);
  busy_s_ += busy_s;
  ++steps_;
  // With steps of seconds, a window of window_s would hold fewer than late_limit steps, and each late step
  // would count as a stall.
  const bool is_whole = now_.elapsed_s >= settings_.window_s && steps_ >= settings_.late_limit;
  return is_whole ? decide(may_rise) : level_;
}

bool LoadGovernor::isOverloaded() const noexcept {
  return last_.late >= settings_.late_limit && last_.lostShare() > settings_.lost_limit;
}

/// True if simulated time would run faster at level + 1, provided that level + 1 loses no time.
bool LoadGovernor::isFasterBelow() const noexcept {
  const auto level = static_cast<std::size_t>(level_);
  return (1 - last_.lostShare()) * speeds_[level] < speeds_[level + 1];
}

int LoadGovernor::decide(bool may_rise) noexcept {
  last_ = {now_.elapsed_s, now_.lost_s, busy_s_ / steps_, now_.late};
  const bool is_calm = level_ > 0 && (above_.late < settings_.late_limit ||
                                      above_.lost_s <= 0.5 * settings_.lost_limit * above_.elapsed_s);
  now_.beginWindow();
  above_.beginWindow();
  busy_s_ = 0;
  steps_ = 0;
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
  above_ = {};
  calm_ = 0;
}

}  // namespace vps::scenes
