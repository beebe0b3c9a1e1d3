// SPDX-License-Identifier: BSD-3-Clause
// Two parts against each other, both ways: each part's points in the other's field.
#pragma once

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// What a part brings to a test; both null-free, and outliving the query.
struct PairSide {
  const VoxMap* map = nullptr;
  const PointShell* shell = nullptr;
};

/// What one pair remembers from pose to pose, both ways.
struct VPS_API PairMemory {
  QueryMemory b_in_a, a_in_b;
  PairMemory(const PairSide& a, const PairSide& b) : b_in_a(*a.map, *b.shell), a_in_b(*b.map, *a.shell) {}
};

/// Penalty wrench on B about O, in A, of B's points in A's field and A's points in B's. Each counts half, so
/// that refining both converges to the same force as one side alone; count, area and volume add up both
/// (area and volume halved), max_depth_m and min_distance_m are over both. A rounded edge of one field is
/// found by the other part's edge points: sharp fits need both. Action equals reaction: with A and B
/// exchanged and X_AB inverted the wrench is the opposite, to rounding. Never throws, allocates, locks.
/// BadPose as queryWrench().
/// @param X_AB  pose of B in A
/// @param p_AO  the point the wrench is about, in A
VPS_API QueryResult queryBothSides(const PairSide& a, const PairSide& b, const Pose& X_AB,
                                   const QueryOptions& options, double k_N_per_m3, const Vec3& p_AO,
                                   TouchSummary& out, PairMemory* memory = nullptr) noexcept;

/// The wrench on B, in A, of both ways: half of each. `F_B_A` is on B, in A; `F_A_B` on A, in B, about the
/// same point.
[[nodiscard]] VPS_API Wrench bothWays(const Wrench& F_B_A, const Wrench& F_A_B, const Mat3& R_AB);

}  // namespace vps
