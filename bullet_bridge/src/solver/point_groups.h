// SPDX-License-Identifier: BSD-3-Clause
// Penalty points of an island with too many of them, in groups of neighbours that are solved as one point
// each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/penalty_pair.h"

namespace vps::bullet {

/// The points [first, end) of a pair, solved as its point `leader` with the stiffness of all.
struct PointGroup {
  std::uint32_t leader = 0, first = 0, end = 0;
  double k_N_per_m = 0;
  double f_n_N = 0;  ///< of all at the end of the last step
};

/// Groups of up to 2^level points with neighbouring ids, which are neighbours in space (PointShell), and with
/// normals within 45 degrees and the same friction. The leader is the deepest, or one that led in the last
/// step and is not clearly less deep: a new leader would be another place to hold by friction, and a part
/// would creep. Level 0: each point alone. Contacts of a manifold stay alone. O(points).
void groupPoints(const PenaltyPair& pair, int level, std::vector<PointGroup>& groups);

/// Greatest level; a group is then as large as an eighth of a cube's face of 20,000 points.
inline constexpr int kCoarsestLevel = 8;

/// The least level at which the pairs have at most `limit` groups; 0 for a limit of 0; at most
/// kCoarsestLevel. O(points) for each level.
int levelFor(std::span<const PenaltyPair* const> pairs, std::size_t limit);

}  // namespace vps::bullet
