// SPDX-License-Identifier: BSD-3-Clause
// Contact of a pointshell with a voxmap at a pose: contacts, distance and penalty wrench; and contact of two
// parts in both directions, each part's points against the other's field.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/errors.h"
#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/query_memory.h"
#include "vps/simd.h"
#include "vps/voxmap.h"
#include "vps/wrench.h"

namespace vps {

/// One point of the shell near the surface of the map.
struct Contact {
  Vec3 p_M = Vec3::Zero();  ///< the shell's point, in the map's frame
  Vec3 n_M = Vec3::Zero();  ///< unit, out of the map's part: the direction that separates the point
  double distance_m = 0;    ///< signed: negative when inside (depth = -distance_m)
  double area_m2 = 0;       ///< surface area that the point represents
  std::uint32_t id = 0;     ///< index of the point in its shell; the same from step to step
  std::uint16_t owner = 0;  ///< the part of a cooked map that the point is near
};

struct QueryOptions {
  double cutoff_m = 0;  ///< report points with distance_m <= cutoff_m (> 0: also near ones, up to the band)
  bool is_exhaustive = false;  ///< test every point, without culling: the reference for tests
  Gradient gradient = Gradient::Continuous;
  Simd simd = Simd::Best;  ///< changes the time, not one bit of the answer
};

/// A buffer for contacts, sized once. When it is full, further contacts are counted in `left_out` and the
/// status is Truncated.
struct ContactSet {
  std::vector<Contact> contacts;  ///< capacity is the limit; never grown by a query
  std::size_t left_out = 0;
  explicit ContactSet(std::size_t capacity = 0) { contacts.reserve(capacity); }
};

struct QueryResult {
  Status status = Status::Ok;
  std::size_t points_tested = 0;
  double min_distance_m =
      0;  ///< least signed distance of any point; exact up to the band, else a lower bound
  bool is_beyond_band = false;  ///< min_distance_m is only a lower bound
};

/// Finds all points of the shell within options.cutoff_m of the map, in ascending id. The culled answer
/// equals the exhaustive one to the bit, for a rigid pose and a map of closed meshes. In a field whose signs
/// contradict each other culling is not exact. O(points near contact).
///
/// A point deeper than the band reports -band_m() as its distance and its own inward normal as the direction
/// out. min_distance_m is exact when there is a contact; otherwise it may be a bound (is_beyond_band), since
/// culled points are not read: use queryDistance() for the distance. When `out` is full the first ids are
/// kept. With a memory, leaves that cannot have come near since the last pose are skipped, and min_distance_m
/// is at most the cutoff. Returns BadPose (no contacts) if X_MP is not finite. Never throws, allocates or
/// locks. Source: McNeely et al. 1999; Tripicchio et al., section 4.1.
VPS_API QueryResult queryContacts(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                  const QueryOptions& options, ContactSet& out,
                                  QueryMemory* memory = nullptr) noexcept;

/// Finds the least signed distance of the shell to the map, by branch and bound over the spheres. Within the
/// band the distance is exact: the field's least reading; -band_m() stands for a depth of band_m() or more.
/// Beyond the band the status is BeyondBand and min_distance_m a lower bound of the true distance, infinite
/// for an empty shell. Never throws, allocates or locks.
VPS_API QueryResult queryDistance(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                  Simd simd = Simd::Best) noexcept;

/// Sums over all touching points.
struct TouchSummary {
  std::size_t count = 0;   ///< touching points: distance below 0
  double area_m2 = 0;      ///< surface area that the touching points represent
  double volume_m3 = 0;    ///< sum of area times depth: about the volume of the overlap
  double max_depth_m = 0;  ///< 0 when nothing touches
  Wrench F_O_M;            ///< penalty wrench on the shell's part about O, in M [N m, N]
};

/// Computes the penalty wrench (see penaltyWrench()) of all touching points without a list of them, for
/// haptic rates. Uses the same points and distances as queryContacts() with cutoff 0; options.cutoff_m is
/// ignored. The order of summation is fixed, so that culling, coherence and processor do not change a bit.
/// min_distance_m is exact when something touches, otherwise a bound; with a memory it is at most 0.
VPS_API QueryResult queryWrench(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                const QueryOptions& options, double k_N_per_m3, const Vec3& p_MO,
                                TouchSummary& out, QueryMemory* memory = nullptr) noexcept;

/// Penalty wrench of a contact set: F = sum of k A d n over touching points. The weight A, the point's area,
/// makes the sum converge under refinement. Source: Tripicchio et al., section 4.1.
/// @param k_N_per_m3  stiffness per area, >= 0
/// @param p_MO        the point the wrench is about, in M
/// @return wrench on the shell's part about O, in M [N m, N]
VPS_API Wrench penaltyWrench(std::span<const Contact> contacts, double k_N_per_m3, const Vec3& p_MO) noexcept;

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
/// the opposite, up to rounding. Never throws, allocates or locks. Returns BadPose as queryWrench() does.
/// @param X_AB  pose of B in A
/// @param p_AO  the point the wrench is about, in A
VPS_API QueryResult queryBothSides(const PairSide& a, const PairSide& b, const Pose& X_AB,
                                   const QueryOptions& options, double k_N_per_m3, const Vec3& p_AO,
                                   TouchSummary& out, PairMemory* memory = nullptr) noexcept;

/// Combines the wrenches of both directions: the mean, on B, in A. `F_B_A` acts on B, in A; `F_A_B` on A, in
/// B, about the same point.
[[nodiscard]] VPS_API Wrench bothWays(const Wrench& F_B_A, const Wrench& F_A_B, const Mat3& R_AB);

}  // namespace vps
