// SPDX-License-Identifier: BSD-3-Clause
// The convex sharp edges of parts, and the crossings between the edges of two parts.
//
// Two parts touch where a point meets a face, or where an edge crosses an edge. Pointshells do not sample
// crossings of edges: the nearest points on both edges may be half the points' spacing away from the
// crossing.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vps/edge_tree.h"
#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// A straight piece of an edge between two faces of a part, in the frame of its EdgeSet.
struct EdgeSegment {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Vec3 into[2] = {Vec3::Zero(), Vec3::Zero()};  ///< unit, across the edge into each face
  Vec3 outward = Vec3::Zero();                  ///< mean of the faces' outward normals, unit
  std::uint16_t owner = 0;                      ///< index of the part
  bool ends[2] = {true, true};  ///< at `from`, at `to`: false where the edge continues in another segment
  /// True where the edge continues in a segment that turns by less than 8 degrees: both segments approximate
  /// a curve.
  bool is_curved[2] = {false, false};

  /// Outward unit normal of the face beside the segment; not defined for a segment without length.
  [[nodiscard]] Vec3 normal(int face) const {
    const Vec3 n = (to - from).cross(into[face]).normalized();
    return n.dot(outward) < 0 ? Vec3(-n) : n;
  }
};

/// Appends a mesh's convex edges whose faces turn by more than 20 degrees, placed by X_MP. Edges with one
/// face or more than two, and edges of faces without area, are left out. O(n log n).
VPS_API void appendEdges(const Mesh& mesh, const Pose& X_MP, std::uint16_t owner,
                         std::vector<EdgeSegment>& out);

struct EdgeCrossing;
struct CrossingRange;
class CrossingMemory;
class MotionTube;

/// Edges with a tree over them.
class VPS_API EdgeSet {
 public:
  EdgeSet() = default;
  /// O(n log n).
  explicit EdgeSet(std::vector<EdgeSegment> segments);
  [[nodiscard]] const std::vector<EdgeSegment>& segments() const noexcept { return segments_; }
  [[nodiscard]] const EdgeTree& tree() const noexcept { return tree_; }  ///< the tree of the segments

 private:
  std::vector<EdgeSegment> segments_;
  EdgeTree tree_;
};

/// An edge of one set crosses an edge of another such that near the crossing each part lies on its own side
/// of the plane along both edges. The contact force is normal to that plane.
struct EdgeCrossing {
  std::uint32_t edge[2] = {0, 0};
  Vec3 p[2] = {Vec3::Zero(), Vec3::Zero()};  ///< the point on each edge, in the frame of set 0
  Vec3 n = Vec3::Zero();                     ///< across both edges, from set 1 to set 0, unit
  /// n (p[0] - p[1]); negative where the parts overlap. While the gap is open, each point may lie past its
  /// edge's end by a tenth of the gap (0.18 of it where the edge continues); the distance there is up to 2 %
  /// (7 %) more.
  double gap_m = 0;
};

/// The limits of a search for crossings.
struct CrossingRange {
  double cutoff_m = 0;  ///< greatest gap, in addition to the approach of the edges in the step
  double depth_m = 0;   ///< greatest overlap
  Pose X_01_end;        ///< pose of set 1 in set 0 after the step
};

/// The pairs of edges that come near each other, kept while two parts move as expected.
class VPS_API CrossingMemory {
 public:
  CrossingMemory();
  ~CrossingMemory();
  CrossingMemory(CrossingMemory&&) noexcept;
  CrossingMemory& operator=(CrossingMemory&&) noexcept;
  /// To be called when a set changes.
  void reset() noexcept { is_valid_ = false; }

 private:
  friend VPS_API void findCrossings(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01,
                                    const CrossingRange& range, std::vector<EdgeCrossing>& out,
                                    CrossingMemory* memory);
  struct Pair {
    std::uint32_t edge[2];
  };
  /// Searches again, unless the last search covered the expected motion from X_01 to X_01_end.
  void find(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01, const Pose& X_01_end,
            double reach_m);
  void search(const EdgeSet& edges0, const EdgeSet& edges1, double reach_m);

  std::vector<Pair> near_;
  std::unique_ptr<MotionTube> tube_;  // the tube of the last search
  double reach_m_ = 0;
  bool is_valid_ = false;
};

/// Appends the crossings with -depth_m <= gap <= cutoff_m now, or gap <= cutoff_m at the end of the step to
/// first order, sorted by edge of set 0, then of set 1. Edges within 5 degrees of parallel have no single
/// crossing; the shells' points find their contacts.
/// @param X_01  frame of set 1 in that of set 0
/// @param memory  state of these two sets from earlier poses; it changes the cost and not the answer
/// Cost: 30 ns for each near pair, and a search for near pairs; with a memory the search is repeated only
/// when the parts have left the motion that it covered. Allocates in `out` and the memory. Source for the
/// test of sides: the arcs of the edges' normals on the Gauss sphere must cross.
VPS_API void findCrossings(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01,
                           const CrossingRange& range, std::vector<EdgeCrossing>& out,
                           CrossingMemory* memory = nullptr);

}  // namespace vps
