// SPDX-License-Identifier: BSD-3-Clause
// Vertices of facets that stand for a curved face: they protrude from the points on the facets.
#pragma once

#include <span>
#include <vector>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet {

/// Moves candidates of curved faces to the deepest vertex of the facet where they are, if that is high enough
/// and deeper in the other body than the candidate. Distance and normal become those of the vertex, exactly.
/// Each vertex takes one candidate.
/// @param candidates        refined where the bodies are
/// @param contact_margin_m  of the settings
void moveToFacetCorners(const PairView& pair, double contact_margin_m, std::vector<Candidate>& candidates);

/// True if one of the points lies on a facet with vertices high enough to be features.
bool haveFacetCorners(const PairView& pair, double contact_margin_m, std::span<const Candidate> candidates);

}  // namespace vps::bullet
