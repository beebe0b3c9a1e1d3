// SPDX-License-Identifier: BSD-3-Clause
#include "surface/box_tree.h"

#include <algorithm>
#include <numeric>

namespace vps::scenes {

namespace {

constexpr std::uint32_t kLeaf = 2;

std::vector<Box> boxesOf(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) boxes[i].add(mesh.vertices[v]);
  return boxes;
}

}  // namespace

BoxTree::BoxTree(const Mesh& mesh) : BoxTree(boxesOf(mesh)) {}

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (order_.empty()) return;
  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first, count = nodes_[n].end - first;
    Box middles;
    for (std::uint32_t i = first; i < first + count; ++i) {
      const Box& box = boxes[order_[i]];
      nodes_[n].box.add(box.min);
      nodes_[n].box.add(box.max);
      middles.add(box.center());
    }
    if (count <= kLeaf) continue;
    int axis = 0;
    middles.size().maxCoeff(&axis);
    const auto at = [&](std::uint32_t i) { return boxes[i].min[axis] + boxes[i].max[axis]; };
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      return at(a) != at(b) ? at(a) < at(b) : a < b;
    });
    nodes_[n].left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, first, first + count / 2, 0});
    nodes_.push_back({{}, first + count / 2, first + count, 0});
  }
}

}  // namespace vps::scenes
