// SPDX-License-Identifier: BSD-3-Clause
// Bounding volume hierarchies: the builder of all binary trees over items in space, and trees of boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "vps/box.h"
#include "vps/export.h"
#include "vps/stoppable.h"

namespace vps {

/// A node of a Hierarchy. The left child of an inner node is the next node.
struct HierarchyNode {
  std::uint32_t first = 0, end = 0;  ///< the node's items: a range of Hierarchy::order
  std::uint32_t right = 0;           ///< the node's right child; 0 for a leaf
  std::uint32_t skip = 0;            ///< the node after the subtree, for a search that leaves the subtree out
  [[nodiscard]] bool isLeaf() const noexcept { return right == 0; }
};

/// A binary tree over items that are known by index. Nodes are in depth-first order, so that
/// - a search needs no stack: it goes to the next node, or to `skip` where a node is left out, and
/// - a loop over the nodes in reverse order reaches children before their parents.
struct Hierarchy {
  std::vector<std::uint32_t> order;  ///< the indices of the items, in the order of the leaves
  std::vector<HierarchyNode> nodes;  ///< the first node is the root; empty without items
};

/// Builds a hierarchy from the root down. Polls for a stop (see stoppable.h). Cost: O(n log n) if divide() is
/// linear and its parts are balanced.
/// @param divide  called once for each node, in the order of the nodes, as divide(std::span<std::uint32_t>)
///                with the indices of the node's items (for the root in ascending order). divide() reorders
///                the indices and returns how many of them, counted from the first, form the left child; 0
///                makes a leaf. With divide() the caller chooses the size of leaves and the criterion of the
///                order, and may compute bounds of the node. divideByKey() and divideByPoint() give the same
///                two parts with every standard library.
template <typename Divide>
[[nodiscard]] Hierarchy buildHierarchy(std::size_t item_count, Divide divide) {
  Hierarchy tree;
  tree.order.resize(item_count);
  std::iota(tree.order.begin(), tree.order.end(), 0U);
  struct Waiting {
    std::uint32_t first, end, parent;
    bool is_right;  ///< the items form the parent's right child
  };
  std::vector<Waiting> waiting;
  if (item_count > 0) waiting.push_back({0, static_cast<std::uint32_t>(item_count), 0, false});
  StridedPoll poll;
  while (!waiting.empty()) {
    poll();
    const Waiting now = waiting.back();
    waiting.pop_back();
    const auto index = static_cast<std::uint32_t>(tree.nodes.size());
    if (now.is_right) tree.nodes[now.parent].right = index;
    tree.nodes.push_back({now.first, now.end, 0, index + 1});
    const auto left_count =
        static_cast<std::uint32_t>(divide(std::span(tree.order).subspan(now.first, now.end - now.first)));
    if (left_count == 0) continue;
    waiting.push_back({now.first + left_count, now.end, index, true});
    waiting.push_back({now.first, now.first + left_count, index, false});
  }
  for (std::size_t n = tree.nodes.size(); n-- > 0;)
    if (!tree.nodes[n].isLeaf()) tree.nodes[n].skip = tree.nodes[tree.nodes[n].right].skip;
  return tree;
}

/// Copies the links of a hierarchy to nodes that also have data, such as bounds: nodes[n] becomes node n of
/// the tree. Resizes `nodes` to the number of the tree's nodes.
template <typename Node>
void copyLinks(const Hierarchy& tree, std::vector<Node>& nodes) {
  nodes.resize(tree.nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) static_cast<HierarchyNode&>(nodes[n]) = tree.nodes[n];
}

/// The axis along which a box is longest; the first axis if several sides are equal.
[[nodiscard]] inline int longestAxis(const Box& box) {
  int axis = 0;
  box.size().maxCoeff(&axis);
  return axis;
}

/// Reorders items so that the first `left_count` are those with the least key(index). Of two items with equal
/// keys the one with the lower index is less, so that both parts, though not the order within them, are the
/// same with every standard library. O(n).
template <typename Key>
void divideByKey(std::span<std::uint32_t> items, std::size_t left_count, Key key) {
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left_count), items.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double key_a = key(a), key_b = key(b);
                     return key_a != key_b ? key_a < key_b : a < b;
                   });
}

/// Calls divideByKey() with the coordinate of points[index] along the longest side of the box around the
/// items' points.
inline void divideByPoint(std::span<std::uint32_t> items, std::size_t left_count,
                          std::span<const Vec3> points) {
  Box box;
  for (const std::uint32_t i : items) box.add(points[i]);
  divideByKey(items, left_count,
              [points, axis = longestAxis(box)](std::uint32_t i) { return points[i][axis]; });
}

/// A bounding volume hierarchy of axis-aligned boxes: each node has half of its parent's items, divided at
/// the median of their centres along one axis. The items' own boxes are not kept.
class VPS_API BoxTree {
 public:
  struct Node : HierarchyNode {
    Box box;  ///< the box around the boxes of the node's items
  };
  /// The axis along which a node is divided.
  enum class Axis {
    OfCenters,  ///< along the longest side of the box around the centres of the items' boxes
    OfBoxes,    ///< along the longest side of the box around the items' boxes
  };

  /// Builds the same tree with every standard library. O(n log n).
  /// @param most_in_leaf  a node with more boxes than this is divided; choose a small value if the test of an
  /// item is costly
  explicit BoxTree(std::span<const Box> boxes, std::uint32_t most_in_leaf = 4, Axis axis = Axis::OfCenters);

  /// The nodes in depth-first order, as in Hierarchy::nodes; empty without boxes.
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  /// Indices of the boxes that the tree was built from.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const noexcept { return order_; }

  /// Calls visit(index) for each item of those leaves for which, and for all nodes above which,
  /// is_wanted(box of the node) is true; in the order of the leaves.
  template <typename IsWanted, typename Visit>
  void forEach(IsWanted is_wanted, Visit visit) const {
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!is_wanted(node.box)) {
        n = node.skip;
        continue;
      }
      if (node.isLeaf())
        for (std::uint32_t i = node.first; i < node.end; ++i) visit(order_[i]);
      ++n;
    }
  }

  /// Calls visit(index) for each of the boxes that shares a point with `box`, in the order of the leaves,
  /// until visit() returns false. O(log n + visited) where few boxes overlap.
  /// @param boxes  the boxes from which the tree was built
  /// @return whether visit() never returned false
  template <typename Visit>
  bool forEachOverlap(std::span<const Box> boxes, const Box& box, Visit visit) const {
    const auto meets = [&box](const Box& other) {
      return (box.min.array() <= other.max.array()).all() && (other.min.array() <= box.max.array()).all();
    };
    for (std::size_t n = box.isEmpty() ? nodes_.size() : 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!meets(node.box)) {
        n = node.skip;
        continue;
      }
      if (node.isLeaf())
        for (std::uint32_t i = node.first; i < node.end; ++i)
          if (meets(boxes[order_[i]]) && !visit(order_[i])) return false;
      ++n;
    }
    return true;
  }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// Calls visit(index of a box of a, of b) for all pairs of boxes in those pairs of leaves for which
/// bound(box of a, box of b, both in one frame) is less than limit(), which may decrease during the search;
/// visits the pair of nodes with the smaller bound first.
/// @param place  transforms a box of a node of b to the frame of a
template <typename Place, typename Bound, typename Limit, typename Visit>
void visitPairs(const BoxTree& a, const BoxTree& b, Place place, Bound bound, Limit limit, Visit visit) {
  struct Waiting {
    std::uint32_t a, b;
    double bound;
  };
  if (a.nodes().empty() || b.nodes().empty()) return;
  const auto boundOf = [&](std::uint32_t i, std::uint32_t k) {
    return bound(a.nodes()[i].box, place(b.nodes()[k].box));
  };
  std::vector<Waiting> stack{{0, 0, boundOf(0, 0)}};
  StridedPoll poll;
  while (!stack.empty()) {
    poll();
    const Waiting now = stack.back();
    stack.pop_back();
    if (!(now.bound < limit())) continue;
    const BoxTree::Node &of_a = a.nodes()[now.a], &of_b = b.nodes()[now.b];
    if (of_a.isLeaf() && of_b.isLeaf()) {
      for (std::uint32_t i = of_a.first; i < of_a.end; ++i)
        for (std::uint32_t k = of_b.first; k < of_b.end; ++k) visit(a.order()[i], b.order()[k]);
      continue;
    }
    const bool halves_a =
        of_b.isLeaf() || (!of_a.isLeaf() && of_a.box.size().squaredNorm() >= of_b.box.size().squaredNorm());
    Waiting first{now.a, now.b, 0}, second = first;
    (halves_a ? first.a : first.b) += 1;
    (halves_a ? second.a : second.b) = halves_a ? of_a.right : of_b.right;
    first.bound = boundOf(first.a, first.b);
    second.bound = boundOf(second.a, second.b);
    if (second.bound < first.bound) std::swap(first, second);
    stack.push_back(second);
    stack.push_back(first);
  }
}

}  // namespace vps
