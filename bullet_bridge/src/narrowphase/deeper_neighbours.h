// SPDX-License-Identifier: BSD-3-Clause
// Points of edges that are deeper than the neighbour that the field chose to stand for them.
#pragma once

#include <vector>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet::inline v0 {

class ManifoldWriter;

/// Of points near each other only the one that is nearest by the field is refined. Beside an edge of the
/// other part the field reads too much, by up to fieldError_m(), and not by the same at the next point: so a
/// point of an edge may be deep inside while its neighbour, which is not, stands for it. From each refined
/// point of an edge that touches this walks along the edges to deeper points by the exact surfaces, where an
/// edge of the other part is within half a voxel, and adds where the walk ends if that is an overlap.
/// @param writer  knows last step's contacts; may be null
/// @param refined  the exact contacts in reach
/// Cost: an exact distance for each neighbour of those points of edges, some 2 us each.
void addDeeperNeighbours(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                         ManifoldWriter* writer, std::vector<Candidate>& refined);

}  // namespace vps::bullet::inline v0
