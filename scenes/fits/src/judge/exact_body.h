// SPDX-License-Identifier: BSD-3-Clause
// A body prepared for exact measures, and the depth or the gap of two bodies.
#pragma once

#include <memory>

#include "surface/triangle_gap.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh_overlap.h"

namespace vps::scenes {

/// Number of pairs of boxes that are tested in one microsecond, which is a unit of Overlap::work; measured.
inline constexpr std::size_t kBoxesPerWork = 8;

/// A solid with the trees that exact measures need.
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
  BoxTree tree_;  ///< tree of the triangles
};

/// The measure of a pair: depth of the overlap, or gap.
struct PairMeasure {
  double depth_m = 0;  ///< depth by deepestOverlap() with sheets; negative: the bodies are apart by this gap
  Vec3 p_W = Vec3::Zero();  ///< the deepest point; not set if the bodies are apart
  Vec3 n_W = Vec3::Zero();  ///< unit direction from a's nearest point to b's nearest point; zero if not known
  std::size_t work = 0;     ///< work that was done, in the unit of Overlap::work
};

/// Measures a pair. The gap is a lower bound of the distance: smaller than the distance by up to a fifth or
/// kOverlapCertain_m, and at most near_m.
PairMeasure measurePair(const ExactBody& a, const Pose& X_WA, const ExactBody& b, const Pose& X_WB,
                        double near_m);

}  // namespace vps::scenes
