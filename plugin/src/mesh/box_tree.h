// SPDX-License-Identifier: BSD-3-Clause
// Searches among many boxes: a mesh may have half a million shells.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// True if two boxes share a point; touching boxes do.
inline bool meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// A tree over boxes, split at their middles; the boxes must outlive it. Construction O(n log n); a search
/// O(log n + found) where few overlap.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes) : boxes_(boxes), order_(boxes.size()) {
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    if (!order_.empty()) nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
    for (std::size_t n = 0; n < nodes_.size(); ++n) halve(n);
  }

  /// Calls visit(index) for the boxes that overlap `box`, in no particular order, until visit returns false.
  /// Returns true if it never did.
  template <typename Visit>
  bool forEachOverlap(const Box& box, Visit visit) const {
    std::uint32_t stack[64];  // halved by count: 32 levels at most, one waiting child each
    int waiting = 0;
    if (!nodes_.empty()) stack[waiting++] = 0;
    while (waiting > 0) {
      const Node& node = nodes_[stack[--waiting]];
      if (!meet(node.box, box)) continue;
      if (node.left != 0) {
        stack[waiting++] = node.left + 1;
        stack[waiting++] = node.left;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.end; ++i)
        if (meet(boxes_[order_[i]], box) && !visit(order_[i])) return false;
    }
    return true;
  }

  /// True if any two boxes overlap.
  [[nodiscard]] bool hasOverlap() const {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
      if (!forEachOverlap(boxes_[i], [i](std::uint32_t other) { return other == i; })) return true;
    return false;
  }

 private:
  static constexpr std::uint32_t kLeaf = 4;
  struct Node {
    Box box;
    std::uint32_t first, end, left;  ///< its part of the order; its left child, or 0
  };

  void halve(std::size_t n) {
    const std::uint32_t first = nodes_[n].first, end = nodes_[n].end;
    Box middles;
    for (std::uint32_t i = first; i < end; ++i) {
      nodes_[n].box.add(boxes_[order_[i]].min);
      nodes_[n].box.add(boxes_[order_[i]].max);
      middles.add(boxes_[order_[i]].center());
    }
    if (end - first <= kLeaf) return;
    int axis = 0;
    middles.size().maxCoeff(&axis);
    const std::uint32_t half = first + (end - first) / 2;
    const auto at = [&](std::uint32_t i) { return boxes_[i].min[axis] + boxes_[i].max[axis]; };
    // A total order, so that every standard library makes the same halves.
    std::nth_element(
        order_.begin() + first, order_.begin() + half, order_.begin() + end,
        [&](std::uint32_t a, std::uint32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
    nodes_[n].left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, first, half, 0});
    nodes_.push_back({{}, half, end, 0});
  }

  std::span<const Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace vps
