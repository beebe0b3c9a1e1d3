// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/body_overlaps.h"

#include <algorithm>

namespace vps::scenes {

namespace {

constexpr double kLimit_m = 10e-6;  // limit of overlap, as for steps of a procedure

double limitOf(const Scene& scene, double scale) {
  double limit_m = kLimit_m * scale;
  for (const SceneStep& step : scene.steps)
    if (step.clearance_m > 0) limit_m = std::min(limit_m, step.clearance_m / 4);
  return limit_m;
}

std::shared_ptr<const Solid> solidOf(const ScenePart& part) {
  const bool has_solid = part.model && part.model->solid && !part.is_cropped;
  return has_solid ? part.model->solid : std::make_shared<const Solid>(part.part.mesh, part.part.name);
}

std::vector<Pose> posesOf(const Scene& scene) {
  std::vector<Pose> X_WP;
  for (const ScenePart& part : scene.parts) X_WP.push_back(part.X_WP);
  return X_WP;
}

/// Parts with the same solid share their surface.
std::vector<MovingBody> bodiesOf(const Scene& scene, const std::vector<Vec3>& centers_P) {
  const auto made = std::make_shared<std::map<const Solid*, std::shared_ptr<const ExactBody>>>();
  std::vector<MovingBody> bodies;
  for (const ScenePart& part : scene.parts) {
    MovingBody body{bounds(part.part.mesh), Vec3::Zero(), part.is_fixed, nullptr};
    body.center_P = centers_P.empty() ? body.box_P.center() : centers_P[bodies.size()];
    body.make = [&part, made] {
      const std::shared_ptr<const Solid> solid = solidOf(part);
      std::shared_ptr<const ExactBody>& exact = (*made)[solid.get()];
      if (!exact) exact = std::make_shared<const ExactBody>(solid);
      return exact;
    };
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace

BodyOverlaps::BodyOverlaps(const Scene& scene, const std::vector<Vec3>& centers_P, double scale)
    : scene_(scene), X_WP_(posesOf(scene)), motions_(bodiesOf(scene, centers_P), X_WP_, 0) {
  for (const ScenePart& part : scene.parts) boxes_P_.push_back(bounds(part.part.mesh));
  judged_.limit_m = limitOf(scene, scale);
}

template <typename Visit>
void BodyOverlaps::forEachOverlap(Visit visit) {
  std::vector<Box> boxes_W;
  for (std::size_t i = 0; i < X_WP_.size(); ++i) boxes_W.push_back(moved(boxes_P_[i], X_WP_[i]));
  for (std::size_t b = 0; b < X_WP_.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (scene_.parts[a].is_fixed && scene_.parts[b].is_fixed) continue;
      if (!overlap(boxes_W[a], boxes_W[b])) continue;
      const Overlap found =
          deepestOverlap(motions_.body(a).overlap(), X_WP_[a], motions_.body(b).overlap(), X_WP_[b], true);
      if (found.depth_m > 0) visit(Pair{a, b}, found);  // visit() may allow this depth
      motions_.setDepth({a, b}, found.depth_m, found.p_W);
    }
}

PairOverlap BodyOverlaps::describe(const Pair& pair, double depth_m, const Vec3& p_W, double time_s) const {
  const auto name = [&](std::size_t part) { return scene_.parts[part].part.name; };
  const bool is_second_first = scene_.parts[pair.first].is_fixed;  // names the part that moves first
  return {name(is_second_first ? pair.second : pair.first), name(is_second_first ? pair.first : pair.second),
          depth_m, p_W, time_s};
}

PairOverlap BodyOverlaps::describe(const DeepestOverlap& deepest) const {
  if (!(deepest.depth_m > 0)) return {};
  return describe({deepest.a, deepest.b}, deepest.depth_m, deepest.p_W, deepest.time_s);
}

void BodyOverlaps::judgeStart() {
  ++judged_.poses_judged;
  forEachOverlap([&](const Pair& pair, const Overlap& found) {
    if (!(found.depth_m > judged_.limit_m)) return;
    starts_[pair] = {describe(pair, found.depth_m, found.p_W, 0), {}, found.depth_m};
    motions_.allow(pair, found.depth_m + judged_.limit_m);
  });
}

void BodyOverlaps::judge(double time_s) {
  ++judged_.poses_judged;
  motions_.search();
  std::map<Pair, double> depths_m;
  forEachOverlap([&](const Pair& pair, const Overlap& found) {
    depths_m[pair] = found.depth_m;
    const auto start = starts_.find(pair);
    const bool is_from_start = start != starts_.end() && !start->second.apart_s;
    if (is_from_start && found.depth_m <= start->second.start.depth_m + judged_.limit_m) return;
    if (found.depth_m > judged_.deepest.depth_m)
      judged_.deepest = describe(pair, found.depth_m, found.p_W, time_s);
  });
  for (auto& [pair, start] : starts_) {
    const auto depth = depths_m.find(pair);
    start.end_depth_m = depth == depths_m.end() ? 0 : depth->second;
    if (start.apart_s || start.end_depth_m > judged_.limit_m) continue;
    start.apart_s = time_s;
    motions_.forbid(pair);
  }
}

JudgedOverlap BodyOverlaps::result() const {
  JudgedOverlap result = judged_;
  if (motions_.deepest().depth_m > result.deepest.depth_m) result.deepest = describe(motions_.deepest());
  for (const auto& [pair, start] : starts_) result.at_start.push_back(start);
  return result;
}

JudgedDepth BodyOverlaps::deepest() const {
  return {describe(motions_.deepestOfAll()), motions_.bound_m(), motions_.measured(), motions_.isSearched()};
}

}  // namespace vps::scenes
