// SPDX-License-Identifier: BSD-3-Clause
// Contact of two parts both ways: each part's points against the other's field.
#pragma once

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// The models of one part. Both must be set and outlive the query.
struct PairSide {
  const VoxMap* map = nullptr;
  const PointShell* shell = nullptr;
};

/// Temporal coherence of one pair, for both directions.
struct PairMemory {
  QueryMemory b_in_a, a_in_b;
  PairMemory(const PairSide& a, const PairSide& b) : b_in_a(*a.map, *b.shell), a_in_b(*b.map, *a.shell) {}
};

/// Penalty wrench on B about O, in A, from B's points in A's field and A's points in B's field. Each
/// direction has weight one half, so that refining both models converges to the same force as one direction
/// alone. Counts are added; area and volume are the means of both directions; max_depth_m and min_distance_m
/// are over both. Sharp fits need both directions, since one part's edge points find overlaps that the other
/// field's rounded edges miss. Action equals reaction: with A and B exchanged and X_AB inverted the wrench is
/// the opposite, up to rounding. Never throws, allocates or locks. BadPose as queryWrench().
/// @param X_AB  pose of B in A
/// @param p_AO  the point the wrench is about, in A
VPS_API QueryResult queryBothSides(const PairSide& a, const PairSide& b, const Pose& X_AB,
                                   const QueryOptions& options, double k_N_per_m3, const Vec3& p_AO,
                                   TouchSummary& out, PairMemory* memory = nullptr) noexcept;

/// Combines the wrenches of both directions: the mean, on B, in A. `F_B_A` acts on B, in A; `F_A_B` on A, in
/// B, about the same point.
[[nodiscard]] VPS_API Wrench bothWays(const Wrench& F_B_A, const Wrench& F_A_B, const Mat3& R_AB);

}  // namespace vps
