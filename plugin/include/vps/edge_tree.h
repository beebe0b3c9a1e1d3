// SPDX-License-Identifier: BSD-3-Clause
// A tree over straight edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/pose.h"

namespace vps {

/// Straight edges with a hierarchy of bounding spheres and lines.
class VPS_API EdgeTree {
 public:
  struct Line {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  };
  struct Node {
    Vec3 center = Vec3::Zero();
    double radius_m = 0;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< the node's edges lie within width_m of this line
    double width_m = 0;
    Vec3 along = Vec3::Zero();  ///< unit, either way: each edge of the node is within spread_rad of it
    double spread_rad = 0;
    std::uint32_t first = 0;    ///< left child (the right child follows); in a leaf the edge
    std::uint32_t is_leaf = 0;  ///< 1 or 0
  };

  EdgeTree() = default;
  /// Every edge must have a length above zero. O(n log n).
  explicit EdgeTree(std::vector<Line> lines);
  [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
  /// The first node is the root; empty if there are no edges.
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  /// Calls visit(index) for each edge within radius_m of a point. The order is fixed but not ascending.
  template <typename Visit>
  void forEachNear(const Vec3& p, double radius_m, Visit&& visit) const {
    if (!nodes_.empty()) visitNear(0, p, radius_m, visit);
  }

 private:
  void build();
  void bound(Node& node, std::span<const std::uint32_t> own) const;
  [[nodiscard]] bool isNear(std::uint32_t edge, const Vec3& p, double radius_m) const noexcept;
  template <typename Visit>
  void visitNear(std::uint32_t at, const Vec3& p, double radius_m, Visit& visit) const {
    const Node& node = nodes_[at];
    if ((p - node.center).norm() > node.radius_m + radius_m) return;
    if (node.is_leaf != 0) {
      if (isNear(node.first, p, radius_m)) visit(node.first);
      return;
    }
    visitNear(node.first, p, radius_m, visit);
    visitNear(node.first + 1, p, radius_m, visit);
  }

  std::vector<Line> lines_;
  std::vector<Node> nodes_;
};

}  // namespace vps
