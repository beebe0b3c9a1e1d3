// SPDX-License-Identifier: BSD-3-Clause
// A hierarchy of bounding spheres, which a rotation does not change.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "vps/box.h"
#include "vps/pose.h"

namespace vps::inline v0 {

class SphereTree {
 public:
  struct Node {
    Vec3 center = Vec3::Zero();
    double radius_m = 0;
    std::uint32_t first = 0;    ///< left child, the right one after it; of a leaf its item
    std::uint32_t is_leaf = 0;  ///< 1 or 0
  };

  /// @param points  calls a function with each point of an item: points(item, visit); a sphere around these
  /// holds the item. O(n log n).
  template <typename Points>
  SphereTree(std::span<const std::uint32_t> items, const Points& points) {
    if (items.empty()) return;
    const auto count = static_cast<std::uint32_t>(items.size());
    struct Range {
      std::uint32_t node, first, count;
    };
    std::vector<Box> boxes(count);
    for (std::uint32_t i = 0; i < count; ++i) points(items[i], [&](const Vec3& p) { boxes[i].add(p); });
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    nodes_.reserve(2 * std::size_t{count});
    nodes_.emplace_back();
    std::vector<Range> waiting{{0, 0, count}};
    while (!waiting.empty()) {
      const Range range = waiting.back();
      waiting.pop_back();
      const std::span<std::uint32_t> own(order.data() + range.first, range.count);
      Box box;
      for (const std::uint32_t i : own) {
        box.add(boxes[i].min);
        box.add(boxes[i].max);
      }
      Node node;
      node.center = box.center();
      for (const std::uint32_t i : own)
        points(items[i],
               [&](const Vec3& p) { node.radius_m = std::max(node.radius_m, (p - node.center).norm()); });
      node.is_leaf = range.count == 1 ? 1 : 0;
      node.first = node.is_leaf != 0 ? items[own[0]] : static_cast<std::uint32_t>(nodes_.size());
      nodes_[range.node] = node;
      if (node.is_leaf != 0) continue;
      int axis = 0;
      box.size().maxCoeff(&axis);
      const std::uint32_t half = range.count / 2;
      // A strict order, so that the tree is the same with every library.
      std::nth_element(own.begin(), own.begin() + half, own.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = boxes[a].center()[axis], at_b = boxes[b].center()[axis];
        return at_a != at_b ? at_a < at_b : a < b;
      });
      nodes_.emplace_back();
      nodes_.emplace_back();
      waiting.push_back({node.first, range.first, half});
      waiting.push_back({node.first + 1, range.first + half, range.count - half});
    }
  }

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

/// Calls visit(i, j) for the items of two trees whose spheres are nearer than reach_m, in a fixed order.
template <typename Visit>
void forEachNearPair(const SphereTree& a, const SphereTree& b, const Pose& X_AB, double reach_m,
                     const Visit& visit) {
  struct Pair {
    std::uint32_t a, b;
  };
  if (a.nodes().empty() || b.nodes().empty()) return;
  // Both trees halve by count, so each is at most 32 deep, and a pair leaves one more waiting.
  Pair stack[80];
  int waiting = 0;
  stack[waiting++] = {0, 0};
  while (waiting > 0) {
    const Pair at = stack[--waiting];
    const SphereTree::Node &in_a = a.nodes()[at.a], &in_b = b.nodes()[at.b];
    const double limit_m = in_a.radius_m + in_b.radius_m + reach_m;
    if ((in_a.center - X_AB * in_b.center).squaredNorm() > limit_m * limit_m) continue;
    if (in_a.is_leaf != 0 && in_b.is_leaf != 0) {
      visit(in_a.first, in_b.first);
    } else if (in_b.is_leaf != 0 || (in_a.is_leaf == 0 && in_a.radius_m >= in_b.radius_m)) {
      stack[waiting++] = {in_a.first + 1, at.b};
      stack[waiting++] = {in_a.first, at.b};
    } else {
      stack[waiting++] = {at.a, in_b.first + 1};
      stack[waiting++] = {at.a, in_b.first};
    }
  }
}

}  // namespace vps::inline v0
