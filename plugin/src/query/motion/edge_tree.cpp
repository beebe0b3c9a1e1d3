// SPDX-License-Identifier: BSD-3-Clause
#include "vps/edge_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "vps/mesh.h"

namespace vps {

EdgeTree::EdgeTree(std::vector<Line> lines) : lines_(std::move(lines)) {
  if (!lines_.empty()) build();
}

// Computes the direction of a node's edges, and the line along it to which they are near.
void EdgeTree::bound(Node& node, std::span<const std::uint32_t> own) const {
  const auto along = [&](std::uint32_t i) { return Vec3((lines_[i].to - lines_[i].from).normalized()); };
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : own) {
    const Vec3 d = along(i);
    node.along += node.along.dot(d) < 0 ? Vec3(-d) : d;
    middle += 0.5 / static_cast<double>(own.size()) * (lines_[i].from + lines_[i].to);
  }
  node.along.normalize();
  double first_m = 0, last_m = 0;
  for (const std::uint32_t i : own) {
    node.spread_rad = std::max(node.spread_rad, std::acos(std::min(1.0, std::abs(node.along.dot(along(i))))));
    for (const Vec3& end : {lines_[i].from, lines_[i].to}) {
      const double at_m = node.along.dot(end - middle);
      first_m = std::min(first_m, at_m);
      last_m = std::max(last_m, at_m);
      node.width_m = std::max(node.width_m, (end - middle - at_m * node.along).norm());
    }
  }
  node.from = middle + first_m * node.along;
  node.to = middle + last_m * node.along;
}

void EdgeTree::build() {
  struct Range {
    std::uint32_t node, first, count;
  };
  std::vector<std::uint32_t> order(lines_.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * lines_.size());
  nodes_.emplace_back();
  std::vector<Range> waiting{{0, 0, static_cast<std::uint32_t>(lines_.size())}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    const std::span<std::uint32_t> own(order.data() + range.first, range.count);
    Box box;
    for (const std::uint32_t i : own) {
      box.add(lines_[i].from);
      box.add(lines_[i].to);
    }
    Node node;
    bound(node, own);
    node.center = box.center();
    for (const std::uint32_t i : own)
      node.radius_m = std::max(
          {node.radius_m, (lines_[i].from - node.center).norm(), (lines_[i].to - node.center).norm()});
    node.is_leaf = range.count == 1 ? 1 : 0;
    node.first = node.is_leaf != 0 ? own[0] : static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node] = node;
    if (node.is_leaf != 0) continue;
    int axis = 0;
    box.size().maxCoeff(&axis);
    const std::uint32_t half = range.count / 2;
    std::nth_element(own.begin(), own.begin() + half, own.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = lines_[a].from[axis] + lines_[a].to[axis],
                   at_b = lines_[b].from[axis] + lines_[b].to[axis];
      return at_a != at_b ? at_a < at_b
                          : a < b;  // a strict order, so that the tree is the same with every library
    });
    nodes_.emplace_back();
    nodes_.emplace_back();
    waiting.push_back({node.first, range.first, half});
    waiting.push_back({node.first + 1, range.first + half, range.count - half});
  }
}

bool EdgeTree::isNear(std::uint32_t edge, const Vec3& p, double radius_m) const noexcept {
  const Line& s = lines_[edge];
  const Vec3 way = s.to - s.from;
  const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - s.from - share * way).norm() <= radius_m;
}

}  // namespace vps
