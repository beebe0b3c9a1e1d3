// SPDX-License-Identifier: BSD-3-Clause
#include "judge/overlap_record.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "judge/box_motion.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr std::size_t kSuspects = 50;  ///< poses that are judged whatever the stride

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
  return verdict;
}

}  // namespace vps::scenes::inline v0
