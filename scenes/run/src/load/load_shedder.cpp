// SPDX-License-Identifier: BSD-3-Clause
#include "load/load_shedder.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "core/machine.h"
#include "vps_device/gains.h"
#include "vps_device/periodic_thread.h"
#include "vps_scenes/run/load_level.h"

namespace vps::scenes {

namespace {

/// The cost ratio of each level that this run may take.
std::vector<double> costRatios(double physics_s, const LoadLimits& limits) {
  constexpr double kLate =
      1.5;  // share of its period that a step may take before it counts as stalled. assumed
  std::vector<double> ratios;
  for (std::size_t level = 1; level < kLoadLevels.size(); ++level) {
    const LoadLevel& load = kLoadLevels[level];
    if (load.time_divisor > 1 && !limits.may_slow) break;
    if (kLate * load.periods() * physics_s > physicsLimit_s(physics_s)) break;
    ratios.push_back(costRatio(level));
  }
  return ratios;
}

/// The speed of simulated time at each level.
std::vector<double> speeds() {
  std::vector<double> speeds;
  for (const LoadLevel& level : kLoadLevels) speeds.push_back(1.0 / level.time_divisor);
  return speeds;
}

const LoadLevel& loadLevelOf(int level) {
  return kLoadLevels[static_cast<std::size_t>(level)];
}

CouplingGains softer(const CouplingGains& a, const CouplingGains& b) {
  CouplingGains gains = device::softerOf(a, b);
  gains.max_force_N = a.max_force_N;
  gains.max_torque_Nm = a.max_torque_Nm;
  return gains;
}

std::string describeOverload(const LoadGovernor::Window& window) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%.0f %% of the periods in %.2f s had no step: a step took %.2g ms, and %d were late",
                100 * window.lostShare(), window.elapsed_s, 1e3 * window.busy_s, window.late);
  return text;
}

std::string describeReserve(const LoadGovernor::Window& window) {
  char text[120];
  std::snprintf(text, sizeof text, "a step takes only %.2g ms now, so the level above fits",
                1e3 * window.busy_s);
  return text;
}

/// The cost of a level, as far as the cost is known in advance.
std::string describeBound(const LoadLevelChange& change, const CouplingGains& own, const LoadLevel& level,
                          const Fidelity& f) {
  if (change.to == 0) return "the scene's own settings apply again";
  char text[300];
  std::snprintf(text, sizeof text,
                "a contact up to %.3g mm deep can go undetected, which is the greatest distance of any place "
                "on the surface from a tested point",
                1e3 * change.unseen_bound_m);
  std::string cost = text;
  if (level.periods() > 1) {
    std::snprintf(text, sizeof text,
                  "; the part answers up to %.3g ms late, so its coupling has %.3g N/m instead of %.3g",
                  1e3 * level.periods() / f.physics_rate_hz, change.k_N_per_m, own.k_N_per_m);
    cost += text;
  }
  if (level.time_divisor > 1)
    cost += "; the part moves at 1/" + std::to_string(level.time_divisor) +
            " of its speed, and feels to the hand " +
            std::to_string(level.time_divisor * level.time_divisor) + " times as heavy";
  return cost;
}

}  // namespace

double costRatio(std::size_t level) {
  const LoadLevel &now = kLoadLevels[level], &before = kLoadLevels[level - 1];
  const double points = now.spacing_factor / before.spacing_factor;
  return points * points * now.periods() / before.periods();
}

std::string describe(const LoadLevel& level, const Fidelity& fidelity) {
  const std::string time =
      level.time_divisor == 1 ? "the clock's" : "1/" + std::to_string(level.time_divisor) + " of the clock's";
  char text[120];
  std::snprintf(text, sizeof text, "points every %.3g mm, physics at %.4g Hz, time at %s",
                1e3 * level.spacing_factor * fidelity.spacing_m,
                fidelity.physics_rate_hz / level.rate_divisor, time.c_str());
  return text;
}

std::string describeCost(const LoadLevelChange& change) {
  if (!change.misread_m) return change.cost;
  char text[120];
  std::snprintf(text, sizeof text, "; at the part's pose the least distance changed by %+.2g um",
                1e6 * *change.misread_m);
  return change.cost + text;
}

LoadShedder::LoadShedder(const Scene& scene, const ModelPlan& plan, Simulation& simulation,
                         HapticDriver& driver, const LoadLimits& limits, GainsAt gains_at, SetField set_field)
    : scene_(scene),
      plan_(plan),
      simulation_(simulation),
      driver_(driver),
      limits_(limits),
      gains_at_(std::move(gains_at)),
      set_field_(std::move(set_field)),
      governor_(costRatios(1 / scene.fidelity.physics_rate_hz, limits), {}, speeds()),
      dt_s_(1 / scene.fidelity.physics_rate_hz),
      gains_(driver.settings().gains) {}

void LoadShedder::update(double busy_s, double time_s, std::size_t part, bool is_holding) {
  if (resampling_.valid()) {
    if (isReady()) finish(time_s);
    return;  // the cost of the new shells can be measured only once they are in use
  }
  const double period_s = loadLevelOf(level_).periods() / scene_.fidelity.physics_rate_hz;
  const int level = governor_.add(busy_s, period_s, mayRise(is_holding));
  if (level == level_) return reportLastLevel(time_s);
  LoadLevelChange change = changeTo(level, time_s);
  if (loadLevelOf(level).spacing_factor != loadLevelOf(level_).spacing_factor)
    startResampling(std::move(change), part);
  else
    setRate(std::move(change));
}

bool LoadShedder::mayRise(bool is_holding) const {
  return level_ > 0 && (!is_holding || loadLevelOf(level_).periods() == loadLevelOf(level_ - 1).periods());
}

LoadLevelChange LoadShedder::changeTo(int level, double time_s) const {
  LoadLevelChange change;
  change.time_s = time_s;
  change.from = level_;
  change.to = level;
  change.was = describe(loadLevelOf(level_), scene_.fidelity);
  change.is = describe(loadLevelOf(level), scene_.fidelity);
  change.lost_share = governor_.last().lostShare();
  change.why = level > level_ ? describeOverload(governor_.last()) : describeReserve(governor_.last());
  change.unseen_bound_m = loadLevelOf(level).spacing_factor * scene_.fidelity.spacing_m;
  change.k_N_per_m = gains_.k_N_per_m;
  return change;
}

void LoadShedder::startResampling(LoadLevelChange change, std::size_t part) {
  const double factor = loadLevelOf(change.to).spacing_factor;
  pending_ = std::move(change);
  resampling_ = std::async(
      std::launch::async, [this, factor, shells = shells_[factor], order = simulation_.orderResampling(part),
                           stop = limits_.stop]() mutable {
        device::leaveRealTime();  // a thread inherits the priority of the thread that starts it
        const double begun_s = wallSeconds();
        order.field.stop = stop;
        if (factor > 1 && !shells) shells = coarserShells(scene_, plan_, factor, stop);
        Resampled resampled{resampleShells(std::move(order), std::move(shells)), 0};
        resampled.wall_s = wallSeconds() - begun_s;
        return resampled;
      });
}

bool LoadShedder::isReady() const {
  return !resampling_.valid() || resampling_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void LoadShedder::finish(double time_s) {
  if (!resampling_.valid()) return;
  LoadLevelChange& change = pending_;
  change.time_s = time_s;
  change.cost = describeBound(change, driver_.settings().gains, loadLevelOf(change.to), scene_.fidelity);
  try {
    Resampled resampled = resampling_.get();
    change.build_wall_s = resampled.wall_s;
    change.misread_m = resampled.shells.misread_m;
    shells_[loadLevelOf(change.to).spacing_factor] = resampled.shells.shells;
    if (resampled.shells.field) set_field_(std::move(*resampled.shells.field));
    simulation_.setShells(std::move(resampled.shells));
  } catch (const std::exception& error) {
    change.is_done = false;
    change.why += std::string("; but the points could not be made: ") + error.what();
  }
  // If a change to a level with less load fails, the level after it can still be tried; if a change to a
  // level with more load fails, the present level is kept and the change is tried again later.
  if (!change.is_done && change.to < change.from)
    governor_.stayAt(change.from);
  else
    level_ = change.to;
  changes_.push_back(std::move(change));
}

void LoadShedder::setRate(LoadLevelChange change) {
  const LoadLevel& level = loadLevelOf(change.to);
  const CouplingGains own = driver_.settings().gains;
  dt_s_ = level.rate_divisor / scene_.fidelity.physics_rate_hz;
  const double period_s = level.periods() / scene_.fidelity.physics_rate_hz;
  gains_ = level.periods() > 1 ? softer(own, gains_at_(1 / period_s)) : own;
  driver_.setLoadLevel(dt_s_, period_s, gains_);
  simulation_.setGains(gains_);
  change.k_N_per_m = gains_.k_N_per_m;
  change.cost = describeBound(change, own, level, scene_.fidelity);
  level_ = change.to;
  changes_.push_back(std::move(change));
}

void LoadShedder::setOwnGains(const CouplingGains& own) {
  const LoadLevel& level = loadLevelOf(level_);
  const double period_s = level.periods() / scene_.fidelity.physics_rate_hz;
  gains_ = level.periods() > 1 ? softer(own, gains_at_(1 / period_s)) : own;
  driver_.setLoadLevel(dt_s_, period_s, gains_);
}

double LoadShedder::timeDivisor() const {
  return loadLevelOf(level_).time_divisor;
}

void LoadShedder::beforeNewModels(double time_s) {
  finish(time_s);
  shells_.clear();
  simulation_.setShells({});
}

void LoadShedder::afterNewModels(double time_s, std::size_t part) {
  if (loadLevelOf(level_).spacing_factor <= 1) return;
  LoadLevelChange change = changeTo(level_, time_s);
  change.why = "the fixed parts were modelled again";
  startResampling(std::move(change), part);
}

void LoadShedder::reportLastLevel(double time_s) {
  if (has_reported_last_level_ || level_ != governor_.lastLevel() || !governor_.isOverloaded()) return;
  has_reported_last_level_ = true;
  LoadLevelChange change = changeTo(level_, time_s);
  change.why =
      describeOverload(governor_.last()) + "; there is no further level, so time runs slower than stated";
  change.cost = describeBound(change, driver_.settings().gains, loadLevelOf(level_), scene_.fidelity);
  change.is_done = false;
  changes_.push_back(std::move(change));
}

}  // namespace vps::scenes
