// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "query/feature_points.h"
#include "query/touch_search.h"
#include "vps/feature_motion.h"

namespace vps::inline v0 {

void FeatureMotion::search(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01,
                           double margin_m) {
  using Kind = FeatureContact::Kind;
  near_.clear();
  margin_m_ = margin_m;
  path_m_ = 0;
  searched_at_ = X_01;
  const Pose X_10 = X_01.inverse();
  const double slack_rad = margin_m / std::min(part0.radius_m(), part1.radius_m());
  const auto addIfNear = [&](Kind kind, std::uint32_t i, std::uint32_t j) {
    Vec3 a[3], b[3];
    const int count = pointsOf(part0, kind, 0, i, a);
    for (int k = 0; k < count; ++k) a[k] = X_10 * a[k];
    pointsOf(part1, kind, 1, j, b);
    const Nearest nearest = nearestOf(kind, a, b);
    const double distance_m = (nearest.p - nearest.q).norm();
    if (distance_m <= margin_m) near_.push_back({kind, {i, j}, distance_m, 0});
  };
  thread_local std::vector<TouchPair> pairs;
  findTouchPairs(part0, part1, X_10, margin_m, slack_rad, pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::CornerOnFacet, corner, facet);
  findTouchPairs(part1, part0, X_01, margin_m, slack_rad, pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::FacetOnCorner, facet, corner);
  thread_local std::vector<std::uint32_t> items, others;
  part0.findEdges(grown(moved(part1.box(), X_01), margin_m), items);
  for (const std::uint32_t i : items) {
    Box box;
    box.add(X_10 * part0.vertices()[part0.edges()[i].from]);
    box.add(X_10 * part0.vertices()[part0.edges()[i].to]);
    part1.findEdges(grown(box, margin_m), others);
    for (const std::uint32_t j : others) addIfNear(Kind::EdgeOnEdge, i, j);
  }
}

}  // namespace vps::inline v0
