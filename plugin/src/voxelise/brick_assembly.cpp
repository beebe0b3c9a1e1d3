// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/brick_assembly.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vps {
namespace {

constexpr auto kFarBits = std::bit_cast<std::uint32_t>(kFar);

/// Gives a far node the band's distance with the sign of `from`, if `from` is not far. Works on the bits,
/// because compilers do not vectorise comparisons of floats by default.
float signedFar(float d, float from, float band_m) {
  const auto bits = std::bit_cast<std::uint32_t>(d), other = std::bit_cast<std::uint32_t>(from);
  const std::uint32_t saturated = std::bit_cast<std::uint32_t>(band_m) | (other & 0x80000000U);
  const bool takes = (bits == kFarBits) & (other != kFarBits);
  return std::bit_cast<float>(takes ? saturated : bits);
}

/// One step of saturate(): `count` nodes take signs from the nodes `back` before them (behind them if
/// negative).
void takeSigns(float* __restrict nodes, int count, int back, float band_m) {
  const float* __restrict from = nodes - back;  // does not overlap with the `count` nodes
  for (int i = 0; i < count; ++i) nodes[i] = signedFar(nodes[i], from[i], band_m);
}

/// Spreads signs over empty cells.
class Filler {
 public:
  explicit Filler(VoxLayout& layout) : layout_(layout) {}

  /// The surface does not pass through empty cells, so a sign spreads from cell to cell. The spreading of
  /// signs starts at the rim, which is outside, so that a fault of the mesh cannot make the outside inside.
  void run() {
    is_filled_.resize(layout_.bricks.size());
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i) is_filled_[i] = !isConstant(layout_.bricks[i]);
    fill(layout_.low, kOutside);  // the rim is one connected layer of empty cells
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i) {
      if (isConstant(layout_.bricks[i])) continue;
      const NodeValue* nodes = layout_.nodesOf(i);
      // An empty neighbour shares a face with the brick; the middle node of the face has the sign.
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Index3 node = Index3::Constant(kBrick / 2);
          node[axis] = step < 0 ? 0 : kBrick;
          const bool is_inside = nodes[nodeIndex(node.x(), node.y(), node.z())] < 0;
          fill(layout_.cellAt(i) + step * Index3::Unit(axis), is_inside ? kInside : kOutside);
        }
    }
  }

 private:
  /// Gives a connected region of empty cells their sign, a run along z at a time.
  void fill(const Index3& from, std::uint32_t with) {
    waiting_.push_back(from);
    while (!waiting_.empty()) {
      const Index3 cell = waiting_.back();
      waiting_.pop_back();
      if (!layout_.holds(cell)) continue;
      const std::size_t row = layout_.cellIndex({cell.x(), cell.y(), layout_.low.z()});
      std::uint8_t* is_filled = &is_filled_[row];
      const int z = cell.z() - layout_.low.z();
      if (is_filled[z] != 0) continue;
      int begin = z, end = z + 1;
      while (begin > 0 && is_filled[begin - 1] == 0) --begin;
      while (end < layout_.size.z() && is_filled[end] == 0) ++end;
      std::fill(is_filled + begin, is_filled + end, std::uint8_t{1});
      std::fill(&layout_.bricks[row] + begin, &layout_.bricks[row] + end, with);
      for (const Index3& step : {Index3(1, 0, 0), Index3(-1, 0, 0), Index3(0, 1, 0), Index3(0, -1, 0)})
        wait(cell + step, begin, end);
    }
  }

  /// Queues one cell of each empty run in part of a row along z.
  void wait(const Index3& at, int begin, int end) {
    if (!layout_.holds(at)) return;
    const std::uint8_t* is_filled = &is_filled_[layout_.cellIndex({at.x(), at.y(), layout_.low.z()})];
    for (int k = begin; k < end; ++k)
      if (is_filled[k] == 0 && (k == begin || is_filled[k - 1] != 0))
        waiting_.emplace_back(at.x(), at.y(), layout_.low.z() + k);
  }

  VoxLayout& layout_;
  std::vector<std::uint8_t> is_filled_;  // by cell: has its brick or its sign
  std::vector<Index3> waiting_;
};

}  // namespace

void saturate(BrickNodes& distance, float band) {
  if (std::find(distance.begin(), distance.end(), kFar) == distance.end()) return;
  // Plane by plane along x, then row by row along y: both process many nodes at a time.
  constexpr int kPlane = kNodes * kNodes;
  for (int x = 1; x < kNodes; ++x) takeSigns(&distance[x * kPlane], kPlane, kPlane, band);
  for (int x = kNodes - 2; x >= 0; --x) takeSigns(&distance[x * kPlane], kPlane, -kPlane, band);
  for (int x = 0; x < kNodes; ++x) {
    for (int y = 1; y < kNodes; ++y) takeSigns(&distance[nodeIndex(x, y, 0)], kNodes, kNodes, band);
    for (int y = kNodes - 2; y >= 0; --y) takeSigns(&distance[nodeIndex(x, y, 0)], kNodes, -kNodes, band);
  }
  // Each plane across z is now either completely known or not at all.
  for (int z = 1; z < kNodes; ++z) {
    if (distance[z] != kFar || distance[z - 1] == kFar) continue;
    for (int i = z; i < kBrickNodes; i += kNodes) takeSigns(&distance[i], 1, 1, band);
  }
  for (int z = kNodes - 2; z >= 0; --z) {
    if (distance[z] != kFar || distance[z + 1] == kFar) continue;
    for (int i = z; i < kBrickNodes; i += kNodes) takeSigns(&distance[i], 1, -1, band);
  }
}

BrickWriter::BrickWriter(VoxLayout& layout, double per_unit, std::size_t expected)
    : layout_(layout), per_unit_(per_unit) {
  layout_.pool = std::make_shared<VoxPool>(expected);
}

void BrickWriter::take(std::size_t count) {
  first_ = takeBricks(layout_, count);
}

std::uint32_t BrickWriter::write(std::size_t slot, BrickNodes& distance) {
  saturate(distance, static_cast<float>(kFullBand / per_unit_));
  const std::uint32_t brick = first_ + static_cast<std::uint32_t>(slot) * kBrickStride;
  NodeValue* nodes = layout_.pool->nodes(brick);
  for (int i = 0; i < kBrickNodes; ++i) nodes[i] = nodeOf(distance[i] * per_unit_);
  std::fill(nodes + kBrickNodes, nodes + kBrickStride, NodeValue{0});
  return brick;
}

void fillEmptyCells(VoxLayout& layout) {
  Filler(layout).run();
}

}  // namespace vps
