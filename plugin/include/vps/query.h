// SPDX-License-Identifier: BSD-3-Clause
// Pointshell against voxmap at a pose: who touches, how deep, and the wrench of it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/query_memory.h"
#include "vps/simd.h"
#include "vps/status.h"
#include "vps/voxmap.h"
#include "vps/wrench.h"

namespace vps {

/// One point of the shell near the surface of the map.
struct Contact {
  Vec3 p_M = Vec3::Zero();  ///< the shell's point, in the map's frame
  Vec3 n_M = Vec3::Zero();  ///< unit, out of the map's part: the way that frees the point
  double distance_m = 0;    ///< signed: negative when inside (depth = -distance_m)
  double area_m2 = 0;       ///< surface the point stands for
  std::uint32_t id = 0;     ///< index of the point in its shell; the same from step to step
  std::uint16_t owner = 0;  ///< which part of a cooked map it is against
};

struct QueryOptions {
  double cutoff_m = 0;  ///< report points with distance_m <= cutoff_m (> 0: also near ones, up to the band)
  bool is_exhaustive = false;  ///< visit every point, without culling: the reference for tests
  Gradient gradient = Gradient::Continuous;
  Simd simd = Simd::Best;  ///< changes the time, not one bit of the answer
};

/// Room for contacts, sized once. When full, further contacts are counted in `left_out` and Status is
/// Truncated.
struct VPS_API ContactSet {
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

/// Finds all points of the shell within options.cutoff_m of the map, in ascending id. Never throws,
/// allocates, locks. Deeper than the band a point reports -band_m() and, as the way out, its own inward
/// normal. min_distance_m is exact when there is a contact; otherwise it may be a bound (is_beyond_band),
/// since culled points are not read: ask queryDistance() for the distance. When `out` is full the first ids
/// are kept. Expects a rigid pose and the map of closed meshes: signs that contradict each other cannot be
/// culled exactly. The culled answer is the exhaustive one, exactly. BadPose (no contacts) if X_MP is not
/// finite. With a memory, the leaves that cannot have come near since the last pose are not looked at:
/// min_distance_m is then no more than the cutoff. O(points near contact). Source: McNeely et al. 1999 and
/// the paper, section 4.1.
VPS_API QueryResult queryContacts(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                  const QueryOptions& options, ContactSet& out,
                                  QueryMemory* memory = nullptr) noexcept;

/// Least signed distance of the shell to the map, by branch and bound over the spheres: exact (the field's
/// least reading) within the band; -band_m() means that deep or deeper. Beyond the band status is BeyondBand
/// and min_distance_m a lower bound of the true distance, infinite for an empty shell. Never throws,
/// allocates, locks.
VPS_API QueryResult queryDistance(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                  Simd simd = Simd::Best) noexcept;

/// What touches, in sum.
struct TouchSummary {
  std::size_t count = 0;   ///< touching points: distance below 0
  double area_m2 = 0;      ///< surface they stand for
  double volume_m3 = 0;    ///< sum of area times depth: about the volume of the overlap
  double max_depth_m = 0;  ///< 0 when nothing touches
  Wrench F_O_M;            ///< penalty wrench on the shell's part about O, in M [N m, N]
};

/// The penalty wrench (see penaltyWrench()) of all touching points, without a list of them: for haptic rates.
/// Same points and distances as queryContacts() with cutoff 0 (the options' own is not used); sums in a fixed
/// order, so that culling, coherence and processor change no bit. min_distance_m is as queryContacts() says:
/// exact when something touches, else a bound; with a memory no more than 0.
VPS_API QueryResult queryWrench(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                                const QueryOptions& options, double k_N_per_m3, const Vec3& p_MO,
                                TouchSummary& out, QueryMemory* memory = nullptr) noexcept;

/// Penalty wrench of a contact set: F = sum of k A d n over touching points (paper, section 4.1, with the
/// point's area as weight, so that it converges under refinement).
/// @param k_N_per_m3  stiffness per area, >= 0
/// @param p_MO        the point the wrench is about, in M
/// @return wrench on the shell's part about O, in M [N m, N]
VPS_API Wrench penaltyWrench(std::span<const Contact> contacts, double k_N_per_m3, const Vec3& p_MO) noexcept;

}  // namespace vps
