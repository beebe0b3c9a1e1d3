// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/solid/interior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/mesh_edges.h"

namespace vps {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

WindingSlope::WindingSlope(const Mesh& mesh) {
  std::vector<std::pair<Box, double>> edges;
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    const int net = surplusOf(same);
    if (net == 0) return;
    const Vec3 &a = mesh.vertices[same[0].low], &b = mesh.vertices[same[0].high];
    Box box;
    box.add(a);
    box.add(b);
    edges.emplace_back(box, std::abs(net) * (b - a).norm());
  });
  const Hierarchy tree = buildHierarchy(edges.size(), [&](std::span<std::uint32_t> items) -> std::size_t {
    Node& node = nodes_.emplace_back();
    for (const std::uint32_t i : items) {
      node.box.add(edges[i].first.min);
      node.box.add(edges[i].first.max);
      node.length_m += edges[i].second;
    }
    constexpr std::size_t kLeafEdges = 4;
    if (items.size() <= kLeafEdges) return 0;
    const int axis = longestAxis(node.box);
    std::stable_sort(items.begin(), items.end(), [&](std::uint32_t a, std::uint32_t b) {
      return edges[a].first.min[axis] + edges[a].first.max[axis] <
             edges[b].first.min[axis] + edges[b].first.max[axis];
    });
    return items.size() / 2;
  });
  copyLinks(tree, nodes_);
  for (const std::uint32_t i : tree.order) edges_.push_back(edges[i]);
}

double WindingSlope::bound(const Box& box) const noexcept {
  double sum = 0;
  for (std::size_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const double gap2 = distance2(node.box, box);
    if (gap2 > 4 * node.box.size().squaredNorm()) {
      sum += node.length_m / gap2;
      n = node.skip;
      continue;
    }
    ++n;
    if (!node.isLeaf()) continue;
    for (std::uint32_t i = node.first; i < node.end; ++i) {
      const double edge_gap2 = distance2(edges_[i].first, box);
      if (!(edge_gap2 > 0)) return kInfinite;
      sum += edges_[i].second / edge_gap2;
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace vps
