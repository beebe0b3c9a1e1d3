// SPDX-License-Identifier: BSD-3-Clause
// How deep two meshes overlap, and how deep a segment lies in a solid, by exact distance and exact crossings,
// without voxmaps.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "vps/box.h"
#include "vps/export.h"
#include "vps/solid.h"

namespace vps {

struct EdgeGroups;

/// A solid with the edges of its surface.
class VPS_API OverlapMesh {
 public:
  /// O(n log n).
  explicit OverlapMesh(std::shared_ptr<const Solid> solid);

  [[nodiscard]] const Solid& solid() const { return *solid_; }
  [[nodiscard]] const Mesh& mesh() const { return solid_->mesh(); }
  [[nodiscard]] const Box& box() const { return box_; }
  /// Vertex pairs of all edges between faces that are not coplanar, and of all edges that do not have exactly
  /// two faces.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& edges() const { return edges_; }
  /// The first and the last triangle at each of edges().
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& trianglesAtEdges() const {
    return triangles_at_edges_;
  }
  /// For the library's own use: boxes around groups of edges().
  [[nodiscard]] const EdgeGroups& groups() const { return *groups_; }

 private:
  std::shared_ptr<const Solid> solid_;
  Box box_;
  std::vector<std::array<std::uint32_t, 2>> edges_, triangles_at_edges_;
  std::shared_ptr<const EdgeGroups> groups_;
};

struct Overlap {
  double depth_m = 0;       ///< 0 when free
  Vec3 p_W = Vec3::Zero();  ///< the deepest point found
  /// Cost of the search: a count of edges and facets, each of about a microsecond. The count is the same in
  /// every run.
  std::size_t work = 0;
};

/// Accuracy of depths.
inline constexpr double kOverlapCertain_m = 0.1e-6;

/// Finds the deepest point of the edges of each mesh in the other one. Surfaces that intersect do so at an
/// edge of one of them, so no overlap is missed. If the deepest point of one mesh lies within a face, the
/// other mesh's edges near this point represent it. Where faces are flush, edges may lie in the other surface
/// although the bodies overlap: therefore triangles at edges that are not clearly outside are also probed
/// between their edges, up to 80 times each. A depth found by probing counts if it is at least twice the
/// depth of the edges; it is a lower bound, as is the depth of two equal bodies at one place. O(edges near
/// the other mesh x log triangles). Allocates. Thread-safe.
/// @param with_sheets  also measures sheets, which have no inside: the depth of their points in the other
///                     mesh. A sheet's depth may be a sixteenth too small, or smaller if 80 probes of a facet
///                     find less.
VPS_API Overlap deepestOverlap(const OverlapMesh& a, const Pose& X_WA, const OverlapMesh& b, const Pose& X_WB,
                               bool with_sheets = false);

/// A point in a solid, in the solid's frame.
struct PointDepth {
  double depth_m = 0;  ///< distance to the surface; 0 outside
  Vec3 p_S = Vec3::Zero();
};

/// Finds the deepest point of segment ab, in the solid's frame: no point of ab is deeper by more than
/// certain_m. The ends are measured exactly.
///
/// If pseudonormals decide which points are inside (not isByWinding()), the segment is divided where it
/// crosses the surface, so that a piece outside costs one search for its nearest point. The depth of a point
/// is at most its distance to any one triangle, which is convex along a segment: a piece that lies along a
/// face, however long and near, takes one or two triangles. If the sign is a winding number, it may change in
/// a hole, where there is no surface. In a hole, and where the crossings contradict the signs of the pieces,
/// the pieces outside are bisected too, as long as the distance, which is 1-Lipschitz, may hide a depth; in
/// the middle of a hole, where the distance jumps, a point may be missed. O(log triangles) for each face
/// along which the segment lies. Thread-safe. Allocates.
/// @return zero for a sheet, which has no inside, and if an end is not finite
/// @param certain_m  > 0
VPS_API PointDepth deepestOnSegment(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m);

}  // namespace vps
