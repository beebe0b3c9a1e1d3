// SPDX-License-Identifier: BSD-3-Clause
#include "winding_signs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh_edges.h"

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// A winding number this far from 0.5 is sure, and may be handed on to neighbours.
constexpr double kSure = 0.25;
/// Off a value before it is handed on: many times the clusters' measured error.
constexpr double kDoubt = 0.02;
/// Values are taken as at most this far from 0.5: crossing a facet within the solid, which no distance tells
/// of, takes one from 2 to 1.
constexpr double kMostMargin = 0.5;

double boxGap2(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).squaredNorm();
}

/// Calls visit(other) for the up to six neighbours of one of size^3 nodes.
template <typename Visit>
void forEachNeighbour(const Index3& at, const Index3& size, Visit visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      const Index3 other = at + step * Index3::Unit(axis);
      if (other[axis] >= 0 && other[axis] < size[axis]) visit(other);
    }
}

}  // namespace

WindingSlope::WindingSlope(const Mesh& mesh) {
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    int net = 0;
    for (const HalfEdge& e : same) net += e.is_forward ? 1 : -1;
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
  std::uint32_t stack[64];  // halving by count: 32 levels at most, one waiting child each
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

WindingSigner::Count WindingSigner::signBrick(OwnNodes& nodes, const Index3& low, double voxel_m,
                                              float band_m) const {
  const auto at = [](int i) { return Index3(i / (kBrick * kBrick), i / kBrick % kBrick, i % kBrick); };
  Box box;
  box.add(voxel_m * low.cast<double>());
  box.add(voxel_m * (low + Index3::Constant(kBrick)).cast<double>());
  const double loss = slope_.bound(box) * voxel_m;  // of margin, a step
  // Where the value can change within the brick unseen, nodes beyond the band cannot take their neighbours'.
  const bool takes_far = loss * kBrick > 0.5 * kSure;
  Count count;
  std::array<float, kOwnNodes> size, margin;
  for (int i = 0; i < kOwnNodes; ++i) {
    const bool is_far = nodes[i] == kFar;
    size[i] = is_far ? (takes_far ? band_m : -1) : std::abs(nodes[i]);
    margin[i] = -1;
    count.nodes += !is_far;
  }
  const auto step_m = static_cast<float>(voxel_m * (1 + 1e-5));
  std::array<std::int16_t, kOwnNodes> queue;
  for (int seed = 0; seed < kOwnNodes; ++seed) {
    if (size[seed] < 0 || margin[seed] >= 0) continue;
    const double w = winding_.at(voxel_m * (low + at(seed)).cast<double>()).w;
    const float sign = w > 0.5 ? -1 : 1;
    ++count.asked;
    margin[seed] = static_cast<float>(std::min(std::abs(w - 0.5), kMostMargin));
    int end = 0;
    queue[end++] = static_cast<std::int16_t>(seed);
    for (int next = 0; next < end; ++next) {
      const int i = queue[next];
      const double left = margin[i] - loss - (i == seed ? kDoubt : 0);
      // On the surface itself both signs are right, and the winding number says so.
      count.sure += nodes[i] != kFar && (margin[i] > kSure || size[i] < 1e-5f * step_m);
      nodes[i] = sign * size[i];
      if (!(left > kSure)) continue;
      forEachNeighbour(at(i), Index3::Constant(kBrick), [&](const Index3& other) {
        const int j = ownIndex(other.x(), other.y(), other.z());
        if (size[j] < 0 || margin[j] >= 0 || !(size[i] + size[j] > step_m)) return;
        margin[j] = static_cast<float>(left);
        queue[end++] = static_cast<std::int16_t>(j);
      });
    }
  }
  return count;
}

void WindingSigner::signNodes(NodeBlocks& blocks, const VoxLayout& layout, double voxel_m) {
  const float band_m = layout.outside()->distance_m[0];
  std::atomic<std::size_t> nodes = 0, sure = 0, asked = 0;
  tbb::parallel_for(std::size_t{0}, blocks.cells.size(), [&](std::size_t i) {
    const Count count = signBrick(blocks.nodes[i], kBrick * layout.cellAt(blocks.cells[i]), voxel_m, band_m);
    nodes += count.nodes;
    sure += count.sure;
    asked += count.asked;
  });
  count_.nodes += nodes;
  count_.sure += sure;
  count_.asked += asked;
}

void WindingSigner::signEmptyCells(VoxLayout& layout, double voxel_m) const {
  if (slope_.isZero()) return;
  const double cell_m = kBrick * voxel_m;
  const auto boxOf = [&](std::size_t i) {
    const Vec3 low = cell_m * layout.cellAt(i).cast<double>();
    return Box{low, low + Vec3::Constant(cell_m)};
  };
  std::vector<float> loss(layout.cells.size()), margin(layout.cells.size(), -1);
  tbb::parallel_for(std::size_t{0}, layout.cells.size(), [&](std::size_t i) {
    if (layout.isConstant(layout.cells[i].brick))
      loss[i] = static_cast<float>(std::min(1.0, slope_.bound(boxOf(i)) * cell_m));
  });
  std::vector<std::size_t> queue;
  for (std::size_t seed = 0; seed < layout.cells.size(); ++seed) {
    if (!layout.isConstant(layout.cells[seed].brick) || margin[seed] >= 0) continue;
    const double w = winding_.at(boxOf(seed).center()).w;
    const VoxBrick* brick = w > 0.5 ? layout.inside() : layout.outside();
    margin[seed] = static_cast<float>(std::min(std::abs(w - 0.5), kMostMargin));
    queue.assign(1, seed);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const std::size_t i = queue[next];
      layout.cells[i].brick = brick;
      forEachNeighbour(layout.cellAt(i) - layout.low, layout.size, [&](const Index3& at) {
        const std::size_t j = layout.cellIndex(layout.low + at);
        // Empty cells touch, and no surface is nearer than the band to either.
        const float left = margin[i] - std::max(loss[i], loss[j]) - (i == seed ? float{kDoubt} : 0.0f);
        if (!layout.isConstant(layout.cells[j].brick) || margin[j] >= 0 || !(left > float{kSure})) return;
        margin[j] = left;
        queue.push_back(j);
      });
    }
  }
}

double WindingSigner::sure() const noexcept {
  return count_.nodes == 0 ? 1 : static_cast<double>(count_.sure) / static_cast<double>(count_.nodes);
}

bool signsAgree(const NodeBlocks& blocks, double voxel_m) {
  const auto step_m = static_cast<float>(voxel_m * (1 + 1e-4));
  std::atomic<bool> agree = true;
  tbb::parallel_for(std::size_t{0}, blocks.nodes.size(), [&](std::size_t block) {
    const OwnNodes& d = blocks.nodes[block];
    for (const int stride : {ownIndex(1, 0, 0), ownIndex(0, 1, 0), ownIndex(0, 0, 1)})
      for (int i = 0; i < kOwnNodes; ++i) {
        if (i / stride % kBrick == kBrick - 1) continue;
        const float a = d[i], b = d[i + stride];
        // Opposite signs: the difference is the sum of the sizes.
        if ((a < 0) != (b < 0) && a != kFar && b != kFar && std::abs(a - b) > step_m)
          agree.store(false, std::memory_order_relaxed);
      }
  });
  return agree;
}

}  // namespace vps
