// SPDX-License-Identifier: BSD-3-Clause
// A tree of boxes, of a mesh's triangles or of parts, which is searched alone or together with another one.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"

namespace vps::scenes {

class BoxTree {
 public:
  struct Node {
    Box box;
    std::uint32_t first = 0, end = 0;  ///< its boxes: a range of order()
    std::uint32_t left = 0;            ///< of an inner node: its children are left and left + 1
    [[nodiscard]] bool isLeaf() const { return left == 0; }
  };

  /// Of the mesh's triangles. O(n log n). The same tree in every standard library.
  explicit BoxTree(const Mesh& mesh);
  /// Of boxes; visits then give indices of this list.
  explicit BoxTree(const std::vector<Box>& boxes);

  /// The root is the first; empty without boxes.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls visit(number of a box) for all boxes in nodes for which `isWanted(box of the node)` is true.
  template <class IsWanted, class Visit>
  void forEach(IsWanted isWanted, Visit visit) const {
    std::vector<std::uint32_t> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const Node& node = nodes_[stack.back()];
      stack.pop_back();
      if (!isWanted(node.box)) continue;
      if (!node.isLeaf()) {
        stack.push_back(node.left + 1);
        stack.push_back(node.left);
        continue;
      }
      for (std::uint32_t i = node.first; i < node.end; ++i) visit(order_[i]);
    }
  }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// Least squared distance of two boxes; 0 where they meet.
inline double distance2(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).squaredNorm();
}

/// Calls visit(number of a box of a, of b) for pairs of leaves, the nearer first, in which
/// `bound(box of a, box of b, in one frame)` is less than `limit()`. `place(box of b)` gives a box of b in
/// the frame of a.
template <class Place, class Bound, class Limit, class Visit>
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
  while (!stack.empty()) {
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
    (halves_a ? first.a : first.b) = halves_a ? of_a.left : of_b.left;
    (halves_a ? second.a : second.b) = (halves_a ? of_a.left : of_b.left) + 1;
    first.bound = boundOf(first.a, first.b);
    second.bound = boundOf(second.a, second.b);
    if (second.bound < first.bound) std::swap(first, second);
    stack.push_back(second);
    stack.push_back(first);
  }
}

}  // namespace vps::scenes
