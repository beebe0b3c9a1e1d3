// SPDX-License-Identifier: BSD-3-Clause
#include "vps/edge_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vps {

EdgeTree::EdgeTree(std::vector<Line> lines) : lines_(std::move(lines)) {
  Hierarchy tree = buildHierarchy(lines_.size(), [&](std::span<std::uint32_t> own) -> std::size_t {
    nodes_.push_back(nodeOf(own));
    if (own.size() == 1) return 0;
    Box box;
    for (const std::uint32_t i : own) {
      box.add(lines_[i].from);
      box.add(lines_[i].to);
    }
    divideByKey(own, own.size() / 2, [&, axis = longestAxis(box)](std::uint32_t i) {
      return lines_[i].from[axis] + lines_[i].to[axis];
    });
    return own.size() / 2;
  });
  copyLinks(tree, nodes_);
  order_ = std::move(tree.order);
  balls_.reserve(nodes_.size());
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    balls_.push_back({node.center, node.radius_m, node.skip - n, node.isLeaf() ? edge(node) : kNoEdge});
  }
}

// The bounds of some edges: a sphere, the mean direction, and the line along this direction that the edges
// are near to.
EdgeTree::Node EdgeTree::nodeOf(std::span<const std::uint32_t> own) const {
  Node node;
  const auto along = [&](std::uint32_t i) { return Vec3((lines_[i].to - lines_[i].from).normalized()); };
  Vec3 middle = Vec3::Zero();
  Box box;
  for (const std::uint32_t i : own) {
    const Vec3 d = along(i);
    node.along += node.along.dot(d) < 0 ? Vec3(-d) : d;
    middle += 0.5 / static_cast<double>(own.size()) * (lines_[i].from + lines_[i].to);
    box.add(lines_[i].from);
    box.add(lines_[i].to);
  }
  node.along.normalize();
  node.center = box.center();
  double first_m = 0, last_m = 0;
  for (const std::uint32_t i : own) {
    node.spread_rad = std::max(node.spread_rad, std::acos(std::min(1.0, std::abs(node.along.dot(along(i))))));
    for (const Vec3& end : {lines_[i].from, lines_[i].to}) {
      const double at_m = node.along.dot(end - middle);
      first_m = std::min(first_m, at_m);
      last_m = std::max(last_m, at_m);
      node.width_m = std::max(node.width_m, (end - middle - at_m * node.along).norm());
      node.radius_m = std::max(node.radius_m, (end - node.center).norm());
    }
  }
  node.from = middle + first_m * node.along;
  node.to = middle + last_m * node.along;
  return node;
}

bool EdgeTree::isNear(std::uint32_t edge, const Vec3& p, double radius_m) const noexcept {
  const Line& s = lines_[edge];
  const Vec3 way = s.to - s.from;
  const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - s.from - share * way).norm() <= radius_m;
}

}  // namespace vps
