// SPDX-License-Identifier: BSD-3-Clause
// What a query may keep from one pose to the next, so that points that cannot have come near are not read.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// Temporal coherence of one map and one shell. Every read or bound of a leaf of points says how far the leaf
/// may move before any of its points can come within the cutoff; every group of leaves keeps an odometer, a
/// sum over poses of the most that any of its points has moved. Until the odometer has gone that far, the
/// leaf is not looked at. Proof: for the field I as it is read, |I(p') - I(p)| <= s |p' - p| with s the
/// steepest slope of its nodes times sqrt 3; and the way between two poses is at most the sum of the ways
/// between those in between (triangle inequality); rounding only ever makes an odometer go farther. So no
/// touching point is ever missed: the answer is the exhaustive one, whatever the motion, jumps included.
///
/// One memory serves one pair and one thread at a time. With another cutoff it starts anew; given to a query
/// of another map or shell it is not used. Made once; queries with it do not allocate.
class VPS_API QueryMemory {
 public:
  /// The shell must outlive the memory, and not change. Cost and room: about 10 bytes a leaf of 16 points.
  QueryMemory(const VoxMap& map, const PointShell& shell);

  /// Forgets: the next query looks at everything.
  void clear() noexcept;
  [[nodiscard]] bool isFor(const VoxMap& map, const PointShell& shell) const noexcept;

 private:
  template <typename Consume>
  friend class CoherentWalk;

  struct Group {
    Vec3 center = Vec3::Zero();  ///< of a sphere around its points, in P [m]
    double radius_m = 0;
    double way = 0;    ///< odometer [voxels]
    double next = -1;  ///< no leaf of the group need be looked at before the odometer is past this
  };
  VoxMap map_;  // shares the map's data, so that another map cannot take its address
  const PointShell* shell_;
  const ShellBlock* blocks_;
  std::vector<Group> groups_;
  std::vector<double> row_next_;         ///< the same for each sixteen leaves
  std::vector<double> leaf_next_;        ///< and for each leaf, in whole rows
  std::vector<std::uint16_t> row_near_;  ///< bit i: leaf i's sphere told nothing last time, only reading does
  Pose X_MP_;
  double cutoff_ = 0;
};

}  // namespace vps
