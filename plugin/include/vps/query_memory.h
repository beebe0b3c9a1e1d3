// SPDX-License-Identifier: BSD-3-Clause
// Temporal coherence: state that a query keeps from pose to pose to skip points that cannot have come near.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// Temporal coherence of one map and one shell. Reading a leaf of points, or bounding the leaf or sixteen
/// neighbouring leaves, tells how far these leaves may move before any of their points can come within the
/// cutoff. Every group of leaves has an odometer: the sum over poses of the largest displacement of any of
/// its points. A leaf is skipped until the odometer has passed the distance that the leaf may move. Proof:
/// the interpolated field I fulfils |I(p') - I(p)| <= s |p' - p| with s the steepest slope of its nodes times
/// sqrt 3; the distance between two poses is at most the sum of the distances between the poses in between
/// (triangle inequality); and rounding always increases the odometer. No touching point is missed: the answer
/// equals the exhaustive one for every motion, jumps included.
///
/// One memory serves one pair and one thread at a time. Queries may have different cutoffs; a cutoff larger
/// than the last query's counts as a motion by the difference. A query of another map or shell ignores the
/// memory. Queries with a memory do not allocate. A memory can be moved, not copied.
class VPS_API QueryMemory {
 public:
  /// The shell must outlive the memory and not change. Memory: about 10 bytes for each leaf of 16 points.
  QueryMemory(const VoxMap& map, const PointShell& shell);

  /// Resets: the next query tests all points.
  void clear() noexcept;
  /// True if the memory was made for this map and shell.
  [[nodiscard]] bool isFor(const VoxMap& map, const PointShell& shell) const noexcept;

 private:
  template <typename Consume>
  friend class CoherentWalk;

  struct Group {
    Vec3 center = Vec3::Zero();  ///< of a sphere around its points, in P [m]
    double radius_m = 0;
    double odometer = 0;       ///< [voxels]
    double next = -1;          ///< no leaf of the group needs a test before the odometer has passed this
    std::uint16_t closed = 0;  ///< bit i: row i was never near; its leaves have no thresholds yet
  };
  void openRow(std::size_t row) noexcept;

  VoxMap map_;  // shares the map's data, so that no other map can get its address
  const PointShell* shell_;
  const ShellBlock* blocks_;
  std::vector<Group> groups_;
  std::vector<double> row_next_;         ///< as Group::next, for each row of sixteen leaves
  std::unique_ptr<double[]> leaf_next_;  ///< as Group::next, for each leaf of opened rows, in whole rows
  std::vector<std::uint16_t>
      row_near_;  ///< bit i: leaf i was too near for a bound of its sphere, so its points are read
  Pose X_MP_;
  static constexpr double kNoQuery = -1e300;
  double cutoff_ = kNoQuery;  ///< of the last query [voxels]
};

}  // namespace vps
