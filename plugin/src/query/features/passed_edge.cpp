// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/feature_contact.h"

#include <algorithm>
#include <limits>

#include "query/features/direction_cone.h"
#include "vps/contact_tolerances.h"

namespace vps {

namespace {

// The multiple of its displacement after which a corner at height_m above a plane passes the plane.
double passes(double height_m, double way_m) {
  return way_m < 0 ? std::max(height_m, 0.0) / -way_m : std::numeric_limits<double>::infinity();
}

// The neighbour across a convex sharp edge on which q lies; kNone if there is none.
std::uint32_t neighbourAt(const FeatureSet& part, std::uint32_t facet, const Vec3& q) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t other = part.neighbours(facet)[k];
    if (other == FeatureSet::kNone || distanceToSide(part, facet, k, q) > kRounding_m) continue;
    if (part.normal(facet).dot(part.normal(other)) > kCosSameFace) continue;
    const auto& t = part.facets()[other];
    double highest_m = 0;
    for (const std::uint32_t v : t)
      highest_m = std::max(highest_m, part.normal(facet).dot(part.vertices()[v] - q));
    if (!(highest_m > kRounding_m)) return other;
  }
  return FeatureSet::kNone;
}

}  // namespace

BorderOwner ownerAtBorder(const FeatureSet& part, std::uint32_t facet, const Vec3& q,
                          const PassingCorner& corner, double tolerated_m) {
  if (part.isTwoSided(facet)) return BorderOwner::Edge;
  const std::uint32_t other = neighbourAt(part, facet, q);
  if (other == FeatureSet::kNone) return BorderOwner::Edge;
  const Vec3 n[2] = {part.normal(facet), part.normal(other)};
  const double height_m[2] = {n[0].dot(corner.r), n[1].dot(corner.r)},
               way_m[2] = {n[0].dot(corner.way), n[1].dot(corner.way)};
  const double at[2] = {passes(height_m[0], way_m[0]), passes(height_m[1], way_m[1])};
  const auto isOver = [&](int i) {
    const double then = at[1 - i];
    return then < std::numeric_limits<double>::infinity() && height_m[i] + then * way_m[i] >= -tolerated_m;
  };
  if (isOver(0) && (!isOver(1) || at[1] < at[0])) return BorderOwner::Facet;
  // The search for corners and facets is certain to find only pairs that can touch.
  const bool can_touch = risesFrom(corner.rays, corner.R.transpose() * n[1], kSinTouch);
  return isOver(1) && can_touch ? BorderOwner::Neighbour : BorderOwner::Edge;
}

}  // namespace vps
