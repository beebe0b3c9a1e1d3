// SPDX-License-Identifier: BSD-3-Clause
#include "judge/overlap_record.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include "judge/body_motion.h"
#include "judge/motion_judge.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kSuspects = 50;  ///< number of poses with the deepest contacts that are always judged

/// Upper bound of the work of the search between two samples, in the unit of Overlap::work. The run is over,
/// so each search can run to its end, which takes about fifty measurements of some ten units each.
constexpr double kCredit = 200e3;

std::vector<MovingBody> bodiesOf(const OverlapJudge& judge, const JudgedBody& moving) {
  const auto body = [](const std::shared_ptr<const PartModel>& model, bool is_fixed) {
    const Box box = bounds(model->solid->mesh());
    return MovingBody{box, box.center(), is_fixed,
                      [model] { return std::make_shared<const ExactBody>(model->solid); }};
  };
  std::vector<MovingBody> bodies;
  for (const OverlapJudge::Mounted& mounted : judge.mounted())
    bodies.push_back(body(mounted.body.model, true));
  bodies.push_back(body(moving.model, false));
  return bodies;
}

/// Computes OverlapVerdict::unsearched_m. A search with a sufficient budget of work leaves no interval above
/// its tolerance; the result is then 0.
double unsearched_m(const MotionJudge& motions, double least_m) {
  const double decided_m = std::max(motions.deepestOfAll().depth_m, least_m);
  const double bound_m = motions.bound_m();
  return bound_m > decided_m + MotionJudge::toleranceOf(decided_m) ? bound_m : 0;
}

/// Searches for overlaps between consecutive samples that are far from each other.
void judgeBetween(const OverlapJudge& judge, const JudgedBody& moving,
                  const std::vector<OverlapSample>& samples, const std::atomic<bool>* stop,
                  OverlapVerdict& verdict) {
  const Box box = bounds(moving.model->solid->mesh());
  std::vector<Pose> X_WP;
  for (const OverlapJudge::Mounted& mounted : judge.mounted()) X_WP.push_back(mounted.X_WB);
  X_WP.emplace_back();
  std::optional<MotionJudge> motions;
  const double least_m = std::max(verdict.worst.depth_m, kFast_m / 2);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (!samples[i].follows) continue;
    if (greatestDisplacement(box, samples[i - 1].X_WP, samples[i].X_WP) <= kFast_m) continue;
    X_WP.back() = samples[i - 1].X_WP;
    if (!motions) {
      motions.emplace(bodiesOf(judge, moving), X_WP, samples[i - 1].time_s);
      motions->setLeast(least_m);
    }
    motions->place(samples[i - 1].time_s, X_WP);
    X_WP.back() = samples[i].X_WP;
    motions->addStep(samples[i].time_s, X_WP, kCredit, stop);
    motions->search(stop);
  }
  if (!motions) return;
  verdict.unsearched_m = unsearched_m(*motions, least_m);
  if (!(motions->deepest().depth_m > verdict.worst.depth_m)) return;
  const DeepestOverlap& deepest = motions->deepest();
  verdict.worst = {deepest.depth_m, deepest.p_W, deepest.a};
  verdict.time_s = deepest.time_s;
}

}  // namespace

OverlapVerdict judgeSamples(const OverlapJudge& judge, const JudgedBody& moving,
                            const std::vector<OverlapSample>& samples, std::size_t stride,
                            const std::atomic<bool>* stop) {
  std::set<std::size_t> judged;
  for (std::size_t i = 0; i < samples.size(); i += stride) judged.insert(i);

  std::vector<std::size_t> by_depth(samples.size());
  std::iota(by_depth.begin(), by_depth.end(), std::size_t{0});
  const auto suspects = static_cast<std::ptrdiff_t>(std::min(kSuspects, samples.size()));
  std::partial_sort(
      by_depth.begin(), by_depth.begin() + suspects, by_depth.end(), [&](std::size_t a, std::size_t b) {
        return samples[a].depth_m != samples[b].depth_m ? samples[a].depth_m > samples[b].depth_m : a < b;
      });
  judged.insert(by_depth.begin(), by_depth.begin() + suspects);

  if (!samples.empty()) judged.insert(samples.size() - 1);

  OverlapVerdict verdict;
  const Box box = bounds(moving.model->solid->mesh());
  const Pose* last = nullptr;
  for (const std::size_t i : judged) {
    if (stop != nullptr && stop->load()) break;
    const OverlapSample& sample = samples[i];
    if (last && greatestDisplacement(box, *last, sample.X_WP) < OverlapJudge::kCertain_m) continue;
    last = &sample.X_WP;
    ++verdict.poses_judged;
    const Penetration found = judge.deepest(moving, sample.X_WP);
    if (found.depth_m > verdict.worst.depth_m) {
      verdict.worst = found;
      verdict.time_s = sample.time_s;
    }
  }
  judgeBetween(judge, moving, samples, stop, verdict);
  return verdict;
}

}  // namespace vps::scenes
