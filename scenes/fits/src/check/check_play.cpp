// SPDX-License-Identifier: BSD-3-Clause
#include "check/check_placed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "motion/play.h"
#include "surface/placed_surface.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kAxes = 6;
constexpr std::size_t kTasks = kAxes + 2;  // tasks of one part: its axes, straight ways out, screw ways out

struct PartTask {
  std::unique_ptr<const MotionSearch> search;
  PlayFrame frame;
  std::vector<CheckedFit> fits;
  double error_m = 0;
};

/// For each part, the pairs and fits that it belongs to.
class Neighbours {
 public:
  struct Pair {
    std::size_t other;
    const CheckedPair* pair;
  };
  Neighbours(const std::vector<PlacedSurface>& parts, const CheckResult& result)
      : pairs_(parts.size()), fits_(parts.size()) {
    std::unordered_map<std::string_view, std::size_t> index_of;
    for (std::size_t i = 0; i < parts.size(); ++i) index_of.emplace(parts[i].name, i);
    for (const CheckedPair& pair : result.pairs) {
      const std::size_t a = index_of.at(pair.a), b = index_of.at(pair.b);
      pairs_[a].push_back({b, &pair});
      pairs_[b].push_back({a, &pair});
    }
    for (const CheckedFit& fit : result.fits)
      for (const std::string& name : {fit.shaft, fit.bore}) fits_[index_of.at(name)].push_back(&fit);
  }
  [[nodiscard]] const std::vector<Pair>& pairsOf(std::size_t part) const { return pairs_[part]; }
  [[nodiscard]] const std::vector<const CheckedFit*>& fitsOf(std::size_t part) const { return fits_[part]; }

 private:
  std::vector<std::vector<Pair>> pairs_;
  std::vector<std::vector<const CheckedFit*>> fits_;
};

/// The task of one part: empty for a part that clashes or is pressed in, since an overlapping part has no
/// free motion to measure.
PartTask taskOf(const std::vector<PlacedSurface>& parts, std::size_t part, const Neighbours& neighbours,
                const std::shared_ptr<const StandingParts>& all) {
  PartTask task;
  std::vector<double> crossing_m(parts.size());
  for (const auto& [other, pair] : neighbours.pairsOf(part)) {
    if (pair->state >= PairState::PressFit) return {};
    crossing_m[other] = pair->error_m;
    task.error_m = std::max(task.error_m, pair->error_m);
  }
  for (const CheckedFit* fit : neighbours.fitsOf(part)) task.fits.push_back(*fit);
  task.frame = playFrame(parts[part], task.fits);
  task.search = std::make_unique<const MotionSearch>(parts[part], all, crossing_m);
  task.error_m += task.search->rest_m();
  return task;
}

bool hasFlushFaces(const PartTask& task) {
  constexpr double kEqual_m = 0.1e-6;  // assumed: rounding of sizes in CAD files, far below any tolerance
  return task.search->rest_m() > 2 * MotionSearch::kRest_m ||
         std::ranges::any_of(task.fits, [](const CheckedFit& fit) {
           return fit.kind == FitKind::Shaft && std::abs(fit.diametral_clearance_m) <= fit.error_m + kEqual_m;
         });
}

void measurePlay(const PlacedSurface& part, const PartTask& task, double leave_m, CheckedPart& out) {
  Play play;
  std::array<std::uint8_t, kAxes> is_given_up = {};
  onAllCores(kTasks, [&](std::size_t axis) {
    if (axis == kAxes) {
      out.ways_out_W = waysOut(*task.search, part, task.frame, task.fits, leave_m);
      return;
    }
    if (axis > kAxes) {
      out.screw_ways_out = screwWaysOut(*task.search, part, task.fits, leave_m);
      return;
    }
    const AxisPlay both = playAlong(*task.search, task.frame, static_cast<int>(axis), leave_m, task.error_m);
    std::array<double, 6>& of = axis < 3 ? play.m : play.rad;
    of[2 * (axis % 3)] = both.way[0];
    of[2 * (axis % 3) + 1] = both.way[1];
    std::array<double, 6>& error = axis < 3 ? play.error_m : play.error_rad;
    error[2 * (axis % 3)] = both.error[0];
    error[2 * (axis % 3) + 1] = both.error[1];
    is_given_up[axis] = both.is_given_up ? 1 : 0;
  });
  out.play = play;
  out.play_axes_W = task.frame.axes_W;
  out.play_center_W = task.frame.center_W;
  out.play_error_m = task.error_m;
  out.is_play_certain = !hasFlushFaces(task) && std::ranges::count(is_given_up, 1) == 0;
  // The error of a contact at half the part's least size from the axis. A contact farther from the axis has a
  // smaller error.
  out.play_error_rad = task.error_m / (0.5 * part.surface->box().size().minCoeff());
}

}  // namespace

void checkPlay(const std::vector<PlacedSurface>& parts, CheckResult& result, const CheckSettings& settings,
               const Progress& progress) {
  if (parts.empty()) return;
  const Neighbours neighbours(parts, result);
  std::vector<const PlacedSurface*> standing;
  for (const PlacedSurface& part : parts) standing.push_back(&part);
  const auto all = std::make_shared<const StandingParts>(std::move(standing));
  const double leave_m = 2 * all->boxes.nodes().front().box.size().norm();
  // The part may overlap the other part of a pair that is left out, so that its free motion is not known.
  std::unordered_set<std::string_view> left_out;
  for (const LeftOutPair& pair : result.left_out) left_out.insert({pair.a, pair.b});
  forEachOnCores(parts.size(), progress, "measuring play", [&](std::size_t i) {
    if (!settings.isAsked(parts[i].name) || left_out.contains(parts[i].name)) return;
    const PartTask task = taskOf(parts, i, neighbours, all);
    if (task.search) measurePlay(parts[i], task, leave_m, result.parts[i]);
  });
}

}  // namespace vps::scenes
