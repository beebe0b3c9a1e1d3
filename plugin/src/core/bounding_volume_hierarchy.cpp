// SPDX-License-Identifier: BSD-3-Clause
#include "vps/bounding_volume_hierarchy.h"

namespace vps {

BoxTree::BoxTree(std::span<const Box> boxes, std::uint32_t most_in_leaf, Axis axis) {
  std::vector<Vec3> centers;  // twice the centres
  centers.reserve(boxes.size());
  for (const Box& box : boxes) centers.emplace_back(box.min + box.max);
  Hierarchy tree = buildHierarchy(boxes.size(), [&](std::span<std::uint32_t> items) -> std::size_t {
    if (items.size() <= most_in_leaf) return 0;
    const std::size_t half = items.size() / 2;
    if (axis == Axis::OfCenters) {
      divideByPoint(items, half, centers);
      return half;
    }
    Box around;
    for (const std::uint32_t i : items) {
      around.add(boxes[i].min);
      around.add(boxes[i].max);
    }
    divideByKey(items, half, [&, k = longestAxis(around)](std::uint32_t i) { return centers[i][k]; });
    return half;
  });
  order_ = std::move(tree.order);
  copyLinks(tree, nodes_);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    const auto add = [&node](const Box& box) {
      node.box.add(box.min);
      node.box.add(box.max);
    };
    if (node.isLeaf()) {
      for (std::uint32_t i = node.first; i < node.end; ++i) add(boxes[order_[i]]);
    } else {
      add(nodes_[n + 1].box);
      add(nodes_[node.right].box);
    }
  }
}

}  // namespace vps
