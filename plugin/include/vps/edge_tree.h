// SPDX-License-Identifier: BSD-3-Clause
// A tree over straight edges.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/export.h"
#include "vps/pose.h"

namespace vps {

/// Straight edges with a hierarchy of bounding spheres and lines.
class VPS_API EdgeTree {
 public:
  struct Line {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  };
  struct Node : HierarchyNode {
    Vec3 center = Vec3::Zero();
    double radius_m = 0;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< the node's edges lie within width_m of this line
    double width_m = 0;
    /// Unit, of either sign: each edge of the node is within spread_rad of this direction.
    Vec3 along = Vec3::Zero();
    double spread_rad = 0;
  };

  EdgeTree() = default;
  /// Every edge must have a length above zero. O(n log n).
  explicit EdgeTree(std::vector<Line> lines);
  [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
  /// The nodes in depth-first order, as in Hierarchy::nodes; a leaf has one edge. Without edges there are no
  /// nodes.
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  /// The children of an inner node of this tree.
  [[nodiscard]] std::array<const Node*, 2> children(const Node& node) const noexcept {
    return {&node + 1, &nodes_[node.right]};
  }
  /// The edge of a leaf.
  [[nodiscard]] std::uint32_t edge(const Node& leaf) const noexcept { return order_[leaf.first]; }
  /// Calls visit(index) for each edge within radius_m of a point. The order is fixed but not ascending.
  template <typename Visit>
  void forEachNear(const Vec3& p, double radius_m, Visit&& visit) const {
    const Ball* const end = balls_.data() + balls_.size();
    for (const Ball* ball = balls_.data(); ball != end;) {
      if (isBeyond((p - ball->center).squaredNorm(), ball->radius_m + radius_m)) {
        ball += ball->skip;
        continue;
      }
      if (ball->edge != kNoEdge && isNear(ball->edge, p, radius_m)) visit(ball->edge);
      ++ball;
    }
  }

 private:
  static constexpr std::uint32_t kNoEdge = ~0U;
  /// The part of a node that forEachNear() reads. In 40 bytes instead of Node's 136, and without a square
  /// root for most nodes, a search takes 0.6 of the time.
  struct Ball {
    Vec3 center;
    double radius_m;
    std::uint32_t skip;  ///< number of nodes from this one to HierarchyNode::skip
    std::uint32_t edge;  ///< the edge of a leaf; kNoEdge for an inner node
  };
  /// Returns the same as sqrt(distance2) > limit, to the bit. Rounding changes squares by less than 1e-15 of
  /// them, so only values that are nearly equal need the root.
  [[nodiscard]] static bool isBeyond(double distance2, double limit) noexcept {
    const double limit2 = limit * limit;
    if (distance2 > limit2 * (1 + 1e-15)) return true;
    if (distance2 < limit2 * (1 - 1e-15)) return false;
    return std::sqrt(distance2) > limit;
  }
  [[nodiscard]] Node nodeOf(std::span<const std::uint32_t> own) const;
  [[nodiscard]] bool isNear(std::uint32_t edge, const Vec3& p, double radius_m) const noexcept;

  std::vector<Line> lines_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  // indices of the edges, by leaf
  std::vector<Ball> balls_;           // the balls of the nodes
};

}  // namespace vps
