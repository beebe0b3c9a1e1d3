// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/load_shedder.h"

#include <algorithm>
#include <cstdio>
#include <exception>

#include "core/wall_clock.h"
#include "vps_device/periodic_thread.h"

namespace vps::scenes {

namespace {

std::vector<double> dearer(double physics_s, const LoadLimits& limits) {
  constexpr double kLate = 1.5;  // of its period, a step that is none too late. assumed
  std::vector<double> all;
  for (std::size_t level = 1; level < kLoadLevels.size(); ++level) {
    const LoadLevel& pace = kLoadLevels[level];
    if (pace.slower > 1 && !limits.may_slow) break;
    if (kLate * pace.periods() * physics_s > physicsLimit_s(physics_s)) break;
    all.push_back(dearerBefore(level));
  }
  return all;
}

const LoadLevel& loadLevelOf(int level) {
  return kLoadLevels[static_cast<std::size_t>(level)];
}

CouplingGains softer(const CouplingGains& a, const CouplingGains& b) {
  CouplingGains gains = a;
  gains.k_N_per_m = std::min(a.k_N_per_m, b.k_N_per_m);
  gains.b_Ns_per_m = std::min(a.b_Ns_per_m, b.b_Ns_per_m);
  gains.k_Nm_per_rad = std::min(a.k_Nm_per_rad, b.k_Nm_per_rad);
  gains.b_Nms_per_rad = std::min(a.b_Nms_per_rad, b.b_Nms_per_rad);
  return gains;
}

std::string lostWords(const LoadGovernor::Window& window) {
  char words[160];
  std::snprintf(words, sizeof words,
                "%.0f %% of %.2f s had no step of their own: a step took %.2g ms, %d were late",
                100 * window.lostShare(), window.elapsed_s, 1e3 * window.busy_s, window.late);
  return words;
}

std::string spareWords(const LoadGovernor::Window& window) {
  char words[120];
  std::snprintf(words, sizeof words, "steps take %.2g ms by now, and more would fit", 1e3 * window.busy_s);
  return words;
}

/// What the pace costs, as far as it is known beforehand.
std::string costWords(const LoadLevelChange& change, const CouplingGains& asked, const LoadLevel& pace,
                      const Fidelity& f) {
  if (change.to == 0) return "nothing is given up any more";
  char words[300];
  std::snprintf(words, sizeof words,
                "no touch is deeper unseen than %.3g mm, the farthest that any place is from a point",
                1e3 * change.unseen_bound_m);
  std::string cost = words;
  if (pace.periods() > 1) {
    std::snprintf(words, sizeof words,
                  "; the part answers up to %.3g ms late, so its coupling has %.3g N/m instead of %.3g",
                  1e3 * pace.periods() / f.physics_rate_hz, change.k_N_per_m, asked.k_N_per_m);
    cost += words;
  }
  if (pace.slower > 1)
    cost += "; the part moves at 1/" + std::to_string(pace.slower) + " of its speed, and gives way as if " +
            std::to_string(pace.slower * pace.slower) + " times as heavy";
  return cost;
}

}  // namespace

LoadShedder::LoadShedder(const Scene& scene, const Plan& plan, Simulation& simulation, PlacedParts& placed,
                         HapticDriver& side, const LoadLimits& limits, GainsAt gains_at)
    : scene_(scene),
      plan_(plan),
      simulation_(simulation),
      placed_(placed),
      driver_(side),
      limits_(limits),
      gains_at_(std::move(gains_at)),
      governor_(dearer(1 / scene.fidelity.physics_rate_hz, limits)),
      dt_s_(1 / scene.fidelity.physics_rate_hz),
      gains_(side.settings().gains) {}

void LoadShedder::keep(double busy_s, double time_s, std::size_t part, bool is_holding) {
  if (under_way_.valid()) {
    if (isReady()) finish(time_s);
    return;  // what it costs shows once it is in place
  }
  const double period_s = loadLevelOf(level_).periods() / scene_.fidelity.physics_rate_hz;
  const int level = governor_.add(busy_s, period_s, mayRise(is_holding));
  if (level == level_) return tellEnd(time_s);
  LoadLevelChange change = changeTo(level, time_s);
  if (loadLevelOf(level).coarser != loadLevelOf(level_).coarser)
    order(std::move(change), part);
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
  change.why = level > level_ ? lostWords(governor_.last()) : spareWords(governor_.last());
  change.unseen_bound_m = loadLevelOf(level).coarser * scene_.fidelity.spacing_m;
  change.k_N_per_m = gains_.k_N_per_m;
  return change;
}

void LoadShedder::order(LoadLevelChange change, std::size_t part) {
  const double coarser = loadLevelOf(change.to).coarser;
  ordered_ = std::move(change);
  under_way_ = std::async(std::launch::async,
                          [this, coarser, known = shells_[coarser], order = simulation_.orderResampling(part),
                           stop = limits_.stop]() mutable {
                            device::leaveRealTime();  // threads are born with their maker's priority
                            const double begun_s = wallSeconds();
                            order.field.stop = stop;
                            if (coarser > 1 && !known) known = coarserShells(scene_, plan_, coarser, stop);
                            Made made{resampleShells(std::move(order), std::move(known)), 0};
                            made.wall_s = wallSeconds() - begun_s;
                            return made;
                          });
}

bool LoadShedder::isReady() const {
  return !under_way_.valid() || under_way_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void LoadShedder::finish(double time_s) {
  if (!under_way_.valid()) return;
  LoadLevelChange& change = ordered_;
  change.time_s = time_s;
  change.cost = costWords(change, driver_.settings().gains, loadLevelOf(change.to), scene_.fidelity);
  try {
    Made made = under_way_.get();
    change.build_wall_s = made.wall_s;
    change.misread_m = made.points.misread_m;
    shells_[loadLevelOf(change.to).coarser] = made.points.shells;
    if (made.points.field) placed_.setField(std::move(*made.points.field));
    simulation_.setShells(std::move(made.points));
  } catch (const std::exception& error) {
    change.is_done = false;
    change.why += std::string("; but other points could not be made: ") + error.what();
  }
  // Where it could not be done downwards the next step is still to come; upwards it is tried again later.
  if (!change.is_done && change.to < change.from)
    governor_.stayAt(change.from);
  else
    level_ = change.to;
  changes_.push_back(std::move(change));
}

void LoadShedder::setRate(LoadLevelChange change) {
  const LoadLevel& pace = loadLevelOf(change.to);
  const CouplingGains asked = driver_.settings().gains;
  dt_s_ = pace.rate_divisor / scene_.fidelity.physics_rate_hz;
  const double period_s = pace.periods() / scene_.fidelity.physics_rate_hz;
  gains_ = pace.periods() > 1 ? softer(asked, gains_at_(1 / period_s)) : asked;
  driver_.setLoadLevel(dt_s_, period_s, gains_);
  simulation_.setGains(gains_);
  change.k_N_per_m = gains_.k_N_per_m;
  change.cost = costWords(change, asked, pace, scene_.fidelity);
  level_ = change.to;
  changes_.push_back(std::move(change));
}

double LoadShedder::slower() const {
  return loadLevelOf(level_).slower;
}

void LoadShedder::beforeNewModels(double time_s) {
  finish(time_s);
  shells_.clear();
  simulation_.setShells({});
}

void LoadShedder::afterNewModels(double time_s, std::size_t part) {
  if (loadLevelOf(level_).coarser <= 1) return;
  LoadLevelChange change = changeTo(level_, time_s);
  change.why = "what is fixed was modelled anew";
  order(std::move(change), part);
}

void LoadShedder::tellEnd(double time_s) {
  if (has_told_end_ || level_ != governor_.lastLevel() || !governor_.isOverloaded()) return;
  has_told_end_ = true;
  LoadLevelChange change = changeTo(level_, time_s);
  change.why = lostWords(governor_.last()) + "; nothing is left to give up, so time goes slower still";
  change.cost = costWords(change, driver_.settings().gains, loadLevelOf(level_), scene_.fidelity);
  change.is_done = false;
  changes_.push_back(std::move(change));
}

}  // namespace vps::scenes
