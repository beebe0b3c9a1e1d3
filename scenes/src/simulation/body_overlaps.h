// SPDX-License-Identifier: BSD-3-Clause
// The overlap of all pairs of bodies of a simulation, by exact distance.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "vps/mesh_overlap.h"
#include "vps_scenes/scene.h"
#include "vps_scenes/simulate.h"

namespace vps::scenes::inline v0 {

/// Measures pairs of which one part can move and whose boxes overlap.
class BodyOverlaps {
 public:
  /// Takes the parts at their designed poses.
  explicit BodyOverlaps(const Scene& scene);
  void move(std::size_t part, const Pose& X_WP) { X_WP_[part] = X_WP; }
  /// Records the pairs that overlap by more than the limit.
  void judgeStart();
  void judge(double time_s);
  [[nodiscard]] JudgedOverlap result() const;

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  /// Calls visit(pair, overlap) for each pair that overlaps.
  template <typename Visit>
  void forEachOverlap(Visit visit) const;
  [[nodiscard]] PairOverlap describe(const Pair& pair, const Overlap& overlap, double time_s) const;

  const Scene& scene_;
  std::vector<OverlapMesh> meshes_;
  std::vector<Pose> X_WP_;
  JudgedOverlap judged_;
  std::map<Pair, OverlappingStart> starts_;
};

}  // namespace vps::scenes::inline v0
