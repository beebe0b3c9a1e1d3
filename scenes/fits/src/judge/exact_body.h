// SPDX-License-Identifier: BSD-3-Clause
// A body as exact measures see it, and how deep two of them overlap or how far they are apart.
#pragma once

#include <memory>

#include "surface/triangle_gap.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh_overlap.h"

namespace vps::scenes {

/// Measured: so many pairs of boxes take a microsecond, a unit of Overlap::work.
inline constexpr std::size_t kBoxesPerWork = 8;

class ExactBody {
 public:
  /// O(n log n).
  explicit ExactBody(std::shared_ptr<const Solid> solid);

  [[nodiscard]] const OverlapMesh& overlap() const { return overlap_; }
  [[nodiscard]] const Mesh& mesh() const { return overlap_.mesh(); }
  [[nodiscard]] const Box& box() const { return overlap_.box(); }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  [[nodiscard]] Triangle triangle(std::uint32_t i) const {
    const auto& t = mesh().triangles[i];
    return {mesh().vertices[t[0]], mesh().vertices[t[1]], mesh().vertices[t[2]]};
  }
  /// The greatest coordinate of a vertex along n, in the body's frame. O(log n) typical.
  [[nodiscard]] double highest_m(const Vec3& n) const;

 private:
  OverlapMesh overlap_;
  BoxTree tree_;  ///< of the triangles
};

/// What a measure of a pair found.
struct PairMeasure {
  double depth_m = 0;       ///< deepestOverlap(), sheets included; without overlap the gap, negative
  Vec3 p_W = Vec3::Zero();  ///< the deepest point; not set without overlap
  Vec3 n_W = Vec3::Zero();  ///< from the nearest point of a to that of b, unit; zero if not known
  std::size_t work = 0;     ///< as Overlap::work
};

/// The gap is a lower bound, by a fifth or kOverlapCertain_m, and at most near_m.
PairMeasure measurePair(const ExactBody& a, const Pose& X_WA, const ExactBody& b, const Pose& X_WB,
                        double near_m);

}  // namespace vps::scenes
