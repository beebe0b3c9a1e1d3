// SPDX-License-Identifier: BSD-3-Clause
// Vertices of facets that stand for a curved face: they protrude from the points on the facets.
#pragma once

#include <span>
#include <vector>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet::inline v0 {

/// A vertex that is less deep than this is left to the contact of its facet [m]: a quarter of the default
/// contact margin. A ball of 14 mm with facets of 1 mm has vertices that are 14 um higher than the middle of
/// its facets, and a ball of 5 mm with 0.2 mm 1 um.
inline constexpr double kFacetCorner_m = 5e-6;

/// Moves candidates of curved faces to the deepest vertex of the facet where they are, if that is deeper in
/// the other body than the candidate and than kFacetCorner_m. Distance and normal become those of the vertex.
/// Each vertex takes one candidate.
/// @param candidates  refined where the bodies are
void moveToFacetCorners(const PairView& pair, std::vector<Candidate>& candidates);

/// True if one of the points lies on a facet whose vertices may be deeper than its middle by kFacetCorner_m.
bool haveFacetCorners(const PairView& pair, std::span<const Candidate> candidates);

}  // namespace vps::bullet::inline v0
