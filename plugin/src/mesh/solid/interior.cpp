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

double boxGap2(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

WindingSlope::WindingSlope(const Mesh& mesh) {
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    const int net = surplusOf(same);
    if (net == 0) return;
    const Vec3 &a = mesh.vertices[same[0].low], &b = mesh.vertices[same[0].high];
    Box box;
    box.add(a);
    box.add(b);
    edges_.emplace_back(box, std::abs(net) * (b - a).norm());
  });
  if (edges_.empty()) return;
  constexpr std::uint32_t kLeafEdges = 4;
  nodes_.emplace_back().count = static_cast<std::uint32_t>(edges_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first, size = nodes_[n].count, half = size / 2;
    Box box;
    double length_m = 0;
    for (std::uint32_t i = first; i < first + size; ++i) {
      box.add(edges_[i].first.min);
      box.add(edges_[i].first.max);
      length_m += edges_[i].second;
    }
    nodes_[n].box = box;
    nodes_[n].length_m = length_m;
    if (size <= kLeafEdges) continue;
    int axis = 0;
    box.size().maxCoeff(&axis);
    const auto range = edges_.begin() + first;
    std::stable_sort(range, range + size, [&](const auto& a, const auto& b) {
      return a.first.min[axis] + a.first.max[axis] < b.first.min[axis] + b.first.max[axis];
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, 0, first, half});
    nodes_.push_back({{}, 0, first + half, size - half});
  }
}

double WindingSlope::bound(const Box& box) const noexcept {
  if (nodes_.empty()) return 0;
  double sum = 0;
  std::uint32_t stack[64];  // halving by count limits the depth to 32, with one waiting child on each level
  int waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const Node& node = nodes_[stack[--waiting]];
    const double gap2 = boxGap2(node.box, box);
    if (gap2 > 4 * node.box.size().squaredNorm()) {
      sum += node.length_m / gap2;
    } else if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const double edge_gap2 = boxGap2(edges_[i].first, box);
        if (!(edge_gap2 > 0)) return kInfinite;
        sum += edges_[i].second / edge_gap2;
      }
    } else {
      stack[waiting++] = node.first + 1;
      stack[waiting++] = node.first;
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace vps
