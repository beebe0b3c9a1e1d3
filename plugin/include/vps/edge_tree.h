// SPDX-License-Identifier: BSD-3-Clause
// A tree over straight edges.
#pragma once

#include <array>
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
    Vec3 along = Vec3::Zero();  ///< unit, either way: each edge of the node is within spread_rad of it
    double spread_rad = 0;
  };

  EdgeTree() = default;
  /// Every edge must have a length above zero. O(n log n).
  explicit EdgeTree(std::vector<Line> lines);
  [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
  /// In depth-first order, as Hierarchy::nodes; a leaf has one edge. Empty without edges.
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
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      const bool is_far = (p - node.center).norm() > node.radius_m + radius_m;
      if (!is_far && node.isLeaf() && isNear(edge(node), p, radius_m)) visit(edge(node));
      n = is_far ? node.skip : n + 1;
    }
  }

 private:
  [[nodiscard]] Node nodeOf(std::span<const std::uint32_t> own) const;
  [[nodiscard]] bool isNear(std::uint32_t edge, const Vec3& p, double radius_m) const noexcept;

  std::vector<Line> lines_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  // of the edges, by leaf
};

}  // namespace vps
