// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/feature_contact.h"

#include <algorithm>
#include <cmath>

#include "vps/contact_tolerances.h"

namespace vps {

double distanceToSide(const FeatureSet& part, std::uint32_t facet, std::size_t k, const Vec3& p) {
  const auto& t = part.facets()[facet];
  const Vec3 &from = part.vertices()[t[k]], way = part.vertices()[t[(k + 1) % 3]] - from;
  return (p - from).cross(way).norm() / way.norm();
}

namespace {

using Kind = FeatureContact::Kind;

/// The corner and the facet of a pair, with the parts to which they belong.
struct CornerAndFacet {
  const FeatureSet& with_corner;
  std::uint32_t corner;
  const FeatureSet& with_facet;
  std::uint32_t facet;
  Mat3 R;  ///< rotation from the frame of the corner's part to that of the facet's part
};

/// @param kind  not EdgeOnEdge
CornerAndFacet cornerAndFacet(const FeatureSet& part0, const FeatureSet& part1, Kind kind, std::uint32_t i,
                              std::uint32_t j, const Mat3& R_10) {
  if (kind == Kind::CornerOnFacet) return {part0, i, part1, j, R_10};
  return {part1, j, part0, i, R_10.transpose()};
}

// True if one of the faces around the corner lies flush on a facet that approximates a curved surface.
// @param facet  the pair's facet, or another facet of the same part
bool isFlushOn(const CornerAndFacet& pair, std::uint32_t facet) {
  if (!pair.with_facet.isCurved(facet)) return false;
  const Vec3 n = pair.R.transpose() * pair.with_facet.normal(facet);
  for (const std::uint32_t edge : pair.with_corner.edgesAt(pair.corner))
    for (const Vec3& own : pair.with_corner.edges()[edge].normal)
      if (own.dot(n) < -kCosSameFace) return true;
  return false;
}

// True if curved surfaces lie flush in each other beside two edges, and the edges meet across these surfaces.
// Each edge must be curved, or lie within a curved surface. Where a round peg's rim comes down on the rim of
// its hole, the walls are opposite too, but the edges meet along the walls.
// @param n_1  direction between the edges, in the frame of part 1
bool isFlush(const FeatureEdge& edge0, const FeatureEdge& edge1, const Mat3& R_10, const Vec3& n_1) {
  const auto isOnCurve = [](const FeatureEdge& edge) { return edge.is_curved || edge.is_slight; };
  if (!isOnCurve(edge0) || !isOnCurve(edge1)) return false;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (edge0.has_curved_face[i] && edge1.has_curved_face[j] &&
          (R_10 * edge0.normal[i]).dot(edge1.normal[j]) < -kCosSameFace &&
          std::abs(edge1.normal[j].dot(n_1)) > kCosAlike)
        return true;
  return false;
}

// True if a corner slides over the border of a facet from a curved neighbour on which it lies flush, as a
// thread's crest does where it leaves its nut. At such a border the polygons overlap by as much as they
// deviate from their curves. The test allows twice this overlap, since at the end of a border that meets
// another edge no curve is known.
// @param p  the nearest point of the facet, in its part's frame
bool slidesOverBorder(const CornerAndFacet& pair, const Vec3& p) {
  const double own_m = pair.with_corner.sagitta_m(pair.with_corner.corners()[pair.corner]);
  if (!(own_m > 0)) return false;
  const FeatureSet& part = pair.with_facet;
  const auto& t = part.facets()[pair.facet];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t other = part.neighbours(pair.facet)[k];
    if (other == FeatureSet::kNone || !isFlushOn(pair, other)) continue;
    const double their_m = std::max(part.sagitta_m(t[k]), part.sagitta_m(t[(k + 1) % 3]));
    if (distanceToSide(part, pair.facet, k, p) < 2 * (own_m + their_m)) return true;
  }
  return false;
}

}  // namespace

bool isLeftToPoints(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                    const Mat3& R_10, const Vec3& n_1) {
  const auto [i, j] = contact.feature;
  if (contact.kind == Kind::EdgeOnEdge) return isFlush(part0.edges()[i], part1.edges()[j], R_10, n_1);
  const CornerAndFacet pair = cornerAndFacet(part0, part1, contact.kind, i, j, R_10);
  const Vec3& on_facet = contact.p[contact.kind == Kind::CornerOnFacet ? 1 : 0];
  return isFlushOn(pair, pair.facet) || slidesOverBorder(pair, on_facet);
}

}  // namespace vps
