// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/body_overlaps.h"

#include <algorithm>

namespace vps::scenes::inline v0 {

namespace {

constexpr double kLimit_m = 10e-6;  // as for steps of a procedure

double limitOf(const Scene& scene) {
  double limit_m = kLimit_m;
  for (const SceneStep& step : scene.steps)
    if (step.clearance_m > 0) limit_m = std::min(limit_m, step.clearance_m / 4);
  return limit_m;
}

}  // namespace

BodyOverlaps::BodyOverlaps(const Scene& scene) : scene_(scene) {
  for (const ScenePart& part : scene.parts) {
    const bool has_solid = part.model && part.model->solid && !part.is_cropped;
    meshes_.emplace_back(has_solid ? part.model->solid
                                   : std::make_shared<const Solid>(part.part.mesh, part.part.name));
    X_WP_.push_back(part.X_WP);
  }
  judged_.limit_m = limitOf(scene);
}

template <typename Visit>
void BodyOverlaps::forEachOverlap(Visit visit) const {
  std::vector<Box> boxes_W;
  for (std::size_t i = 0; i < meshes_.size(); ++i) boxes_W.push_back(moved(meshes_[i].box(), X_WP_[i]));
  for (std::size_t b = 0; b < meshes_.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (scene_.parts[a].is_fixed && scene_.parts[b].is_fixed) continue;
      if (!overlap(boxes_W[a], boxes_W[b])) continue;
      const Overlap found = deepestOverlap(meshes_[a], X_WP_[a], meshes_[b], X_WP_[b]);
      if (found.depth_m > 0) visit(Pair{a, b}, found);
    }
}

PairOverlap BodyOverlaps::describe(const Pair& pair, const Overlap& overlap, double time_s) const {
  const auto name = [&](std::size_t part) { return scene_.parts[part].part.name; };
  const bool is_second_first = scene_.parts[pair.first].is_fixed;  // the part that moves
  return {name(is_second_first ? pair.second : pair.first), name(is_second_first ? pair.first : pair.second),
          overlap.depth_m, overlap.p_W, time_s};
}

void BodyOverlaps::judgeStart() {
  ++judged_.poses_judged;
  forEachOverlap([&](const Pair& pair, const Overlap& found) {
    if (found.depth_m > judged_.limit_m) starts_[pair] = {describe(pair, found, 0), {}, found.depth_m};
  });
}

void BodyOverlaps::judge(double time_s) {
  ++judged_.poses_judged;
  std::map<Pair, double> depths_m;
  forEachOverlap([&](const Pair& pair, const Overlap& found) {
    depths_m[pair] = found.depth_m;
    const auto start = starts_.find(pair);
    const bool is_from_start = start != starts_.end() && !start->second.apart_s;
    if (is_from_start && found.depth_m <= start->second.start.depth_m + judged_.limit_m) return;
    if (found.depth_m > judged_.deepest.depth_m) judged_.deepest = describe(pair, found, time_s);
  });
  for (auto& [pair, start] : starts_) {
    const auto depth = depths_m.find(pair);
    start.end_depth_m = depth == depths_m.end() ? 0 : depth->second;
    if (!start.apart_s && start.end_depth_m <= judged_.limit_m) start.apart_s = time_s;
  }
}

JudgedOverlap BodyOverlaps::result() const {
  JudgedOverlap result = judged_;
  for (const auto& [pair, start] : starts_) result.at_start.push_back(start);
  return result;
}

}  // namespace vps::scenes::inline v0
