// SPDX-License-Identifier: BSD-3-Clause
#include "brick_assembly.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;
using BrickNodes = std::array<float, kBrickNodes>;

/// Gives far nodes of a brick the band's distance, with the sign of the node beside them: where one of two
/// neighbours is far, the surface does not pass between, since the band is wider than a voxel.
void saturate(BrickNodes& distance_m, float band_m) {
  const auto take = [&](int far, int from) {
    if (distance_m[far] == kFar && distance_m[from] != kFar)
      distance_m[far] = std::copysign(band_m, distance_m[from]);
  };
  // Up and down along z fills each row that knows a sign; then along y each plane; then along x the brick.
  constexpr int kStride[3] = {nodeIndex(0, 0, 1), nodeIndex(0, 1, 0), nodeIndex(1, 0, 0)};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < kNodes; ++i)
      for (int j = 0; j < kNodes; ++j) {
        const int stride = kStride[axis];
        const int row = i * kStride[(axis + 1) % 3] + j * kStride[(axis + 2) % 3];
        for (int k = 1; k < kNodes; ++k) take(row + k * stride, row + (k - 1) * stride);
        for (int k = kNodes - 1; k > 0; --k) take(row + (k - 1) * stride, row + k * stride);
      }
}

class Assembler {
 public:
  Assembler(VoxLayout& layout, const NodeBlocks& blocks, double band_m)
      : layout_(layout), blocks_(blocks), band_m_(static_cast<float>(band_m)) {
    block_of_.assign(layout.bricks.size(), -1);
    for (std::size_t i = 0; i < blocks.cells.size(); ++i)
      block_of_[blocks.cells[i]] = static_cast<std::int32_t>(i);
  }

  void makeBricks() {
    const std::size_t count = blocks_.cells.size();
    std::vector<std::int32_t> slot(count);  // 1 if the brick is kept, then its place
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      BrickNodes nodes;
      collect(i, nodes);
      slot[i] = std::any_of(nodes.begin(), nodes.end(), [](float d) { return d != kFar; });
    });
    std::int32_t kept = 0;
    for (std::int32_t& s : slot) s = s != 0 ? kept++ : -1;

    layout_.pool = std::make_shared<VoxPool>(static_cast<std::size_t>(kept));
    const std::uint32_t first = layout_.pool->take(static_cast<std::size_t>(kept));
    const double quantum_m = quantumOf(band_m_);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (slot[i] < 0) return;
      const std::uint32_t brick = first + static_cast<std::uint32_t>(slot[i]) * kBrickStride;
      BrickNodes distance_m;
      collect(i, distance_m);
      saturate(distance_m, band_m_);
      NodeValue* nodes = layout_.pool->nodes(brick);
      std::fill(std::transform(distance_m.begin(), distance_m.end(), nodes,
                               [&](float d) { return toNode(d, quantum_m); }),
                nodes + kBrickStride, NodeValue{0});
      layout_.pool->owner(brick) = 0;
      layout_.pool->mixed(brick) = nullptr;
      layout_.bricks[blocks_.cells[i]] = brick;
    });
  }

  /// Empty cells meet the surface nowhere, so a sign spreads from cell to cell. From the rim first, which is
  /// outside: a flaw in the mesh then cannot turn the outside in.
  void fillEmptyCells() {
    is_filled_.assign(layout_.bricks.size(), false);
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i) is_filled_[i] = !isConstant(layout_.bricks[i]);
    fill(layout_.low, kOutside);  // the rim is one connected layer of empty cells
    for (std::size_t i = 0; i < layout_.bricks.size(); ++i) {
      if (isConstant(layout_.bricks[i])) continue;
      const NodeValue* nodes = layout_.nodesOf(i);
      // An empty neighbour shares a face with the brick, whose middle node tells the sign.
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
  /// The nodes of a brick: its own, and the first ones of seven neighbours as its border.
  void collect(std::size_t i, BrickNodes& distance_m) const {
    const Index3 cell = layout_.cellAt(blocks_.cells[i]);
    for (int part = 0; part < 8; ++part) {
      const Index3 step(part >> 2, part >> 1 & 1, part & 1);
      const Index3 neighbour = cell + step;
      const std::int32_t block = layout_.holds(neighbour) ? block_of_[layout_.cellIndex(neighbour)] : -1;
      for (int x = 0; x < (step.x() ? 1 : kBrick); ++x)
        for (int y = 0; y < (step.y() ? 1 : kBrick); ++y)
          for (int z = 0; z < (step.z() ? 1 : kBrick); ++z)
            distance_m[nodeIndex(x + kBrick * step.x(), y + kBrick * step.y(), z + kBrick * step.z())] =
                block < 0 ? kFar : blocks_.nodes[block][ownIndex(x, y, z)];
    }
  }

  void fill(const Index3& from, std::uint32_t with) {
    waiting_.push_back(from);
    while (!waiting_.empty()) {
      const Index3 cell = waiting_.back();
      waiting_.pop_back();
      if (!layout_.holds(cell)) continue;
      const std::size_t index = layout_.cellIndex(cell);
      if (is_filled_[index]) continue;
      is_filled_[index] = true;
      layout_.bricks[index] = with;
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) waiting_.push_back(cell + step * Index3::Unit(axis));
    }
  }

  VoxLayout& layout_;
  const NodeBlocks& blocks_;
  const float band_m_;
  std::vector<std::int32_t> block_of_;  // by directory index; -1: none
  std::vector<bool> is_filled_;         // has its brick or its sign
  std::vector<Index3> waiting_;
};

}  // namespace

void assembleBricks(VoxLayout& layout, const NodeBlocks& blocks, double band_m) {
  Assembler assembler(layout, blocks, band_m);
  assembler.makeBricks();
  assembler.fillEmptyCells();
}

}  // namespace vps
