// SPDX-License-Identifier: BSD-3-Clause
#include "query/motion_tube.h"
#include "query/moving_features.h"
#include "query/touch_search.h"
#include "vps/feature_motion.h"

namespace vps {

void FeatureMotion::search(const FeatureSet& part0, const FeatureSet& part1) {
  using Kind = FeatureContact::Kind;
  near_.clear();
  path_m_ = 0;
  const double margin_m = tube_->margin_m() + kLeastShare * rest_m(part0, part1);
  const Sweep X_01{tube_->from(), tube_->to()}, X_10{X_01.from.inverse(), X_01.to.inverse()};
  const auto addIfNear = [&](Kind kind, std::uint32_t i, std::uint32_t j) {
    Features f;
    f.load(part0, part1, kind, {i, j});
    f.moveFrom(X_10.from, X_10.to);
    Reach reach;
    reach.nearest = nearestOf(kind, f.a, f.b);
    const double distance_m = reach.nearest.distance_m();
    if (distance_m <= margin_m || findReach(kind, f, margin_m, distance_m, reach))
      near_.push_back({kind, {i, j}, distance_m, 0});
  };
  thread_local std::vector<TouchPair> pairs;
  findTouchPairs(part0, part1, X_10, margin_m, tube_->turn_rad(), pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::CornerOnFacet, corner, facet);
  findTouchPairs(part1, part0, X_01, margin_m, tube_->turn_rad(), pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::FacetOnCorner, facet, corner);
  EdgePairSearch(part1.edgeTree(), part0.edgeTree(), X_10, tube_->turn_rad(), margin_m)
      .run([&](std::uint32_t j, std::uint32_t i) { addIfNear(Kind::EdgeOnEdge, i, j); });
}

}  // namespace vps
