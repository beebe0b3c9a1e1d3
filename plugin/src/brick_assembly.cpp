// SPDX-License-Identifier: BSD-3-Clause
#include "brick_assembly.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace vps {
namespace {

constexpr int kBrick = VoxMap::kBrick;

constexpr auto kFarBits = std::bit_cast<std::uint32_t>(kFar);

/// Takes over the sign of `from` where a node is far and `from` is not. On the bits, since compilers do not
/// put comparisons of floats into vectors by default.
float signedFar(float d, float from, float band_m) {
  const auto bits = std::bit_cast<std::uint32_t>(d), other = std::bit_cast<std::uint32_t>(from);
  const std::uint32_t saturated = std::bit_cast<std::uint32_t>(band_m) | (other & 0x80000000U);
  const bool takes = (bits == kFarBits) & (other != kFarBits);
  return std::bit_cast<float>(takes ? saturated : bits);
}

/// One step of saturate(): `count` nodes from those `back` before (or, negative, behind) them.
void takeSigns(float* __restrict nodes, int count, int back, float band_m) {
  const float* __restrict from = nodes - back;  // as many nodes, but none of them
  for (int i = 0; i < count; ++i) nodes[i] = signedFar(nodes[i], from[i], band_m);
}

class Assembler {
 public:
  Assembler(VoxLayout& layout, const NodeBlocks& blocks) : layout_(layout), blocks_(blocks) {
    block_of_.assign(layout.cells.size(), -1);
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

    auto pool = std::make_shared<VoxPool>();
    pool->bricks.resize(static_cast<std::size_t>(kept));
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (slot[i] < 0) return;
      VoxBrick& brick = pool->bricks[slot[i]];
      collect(i, brick.distance_m);
      saturate(brick.distance_m, layout_.outside()->distance_m[0]);
      layout_.cells[blocks_.cells[i]].brick = &brick;
    });
    layout_.pools = {pool};
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

  VoxLayout& layout_;
  const NodeBlocks& blocks_;
  std::vector<std::int32_t> block_of_;  // by directory index; -1: none
};

/// Spreads signs over empty cells.
class Filler {
 public:
  explicit Filler(VoxLayout& layout) : layout_(layout) {}

  /// Empty cells meet the surface nowhere, so a sign spreads from cell to cell. From the rim first, which is
  /// outside: a flaw in the mesh then cannot turn the outside in.
  void run() {
    fill(layout_.low, layout_.outside());  // the rim is one connected layer of empty cells
    for (std::size_t i = 0; i < layout_.cells.size(); ++i) {
      const VoxBrick* brick = layout_.cells[i].brick;
      if (brick == nullptr || layout_.isConstant(brick)) continue;
      // An empty neighbour shares a face with the brick, whose middle node tells the sign.
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Index3 node = Index3::Constant(kBrick / 2);
          node[axis] = step < 0 ? 0 : kBrick;
          const bool is_inside = brick->distance_m[nodeIndex(node.x(), node.y(), node.z())] < 0;
          fill(layout_.cellAt(i) + step * Index3::Unit(axis),
               is_inside ? layout_.inside() : layout_.outside());
        }
    }
  }

 private:
  /// Gives a connected region of empty cells their sign, a run along z at a time.
  void fill(const Index3& from, const VoxBrick* with) {
    waiting_.push_back(from);
    while (!waiting_.empty()) {
      const Index3 cell = waiting_.back();
      waiting_.pop_back();
      if (!layout_.holds(cell)) continue;
      VoxCell* row = &layout_.cells[layout_.cellIndex({cell.x(), cell.y(), layout_.low.z()})];
      const int z = cell.z() - layout_.low.z();
      if (row[z].brick != nullptr) continue;
      int begin = z, end = z + 1;
      while (begin > 0 && row[begin - 1].brick == nullptr) --begin;
      while (end < layout_.size.z() && row[end].brick == nullptr) ++end;
      for (int k = begin; k < end; ++k) row[k].brick = with;
      for (const Index3& step : {Index3(1, 0, 0), Index3(-1, 0, 0), Index3(0, 1, 0), Index3(0, -1, 0)})
        wait(cell + step, begin, end);
    }
  }

  /// Remembers one cell of each empty run in part of a row along z.
  void wait(const Index3& at, int begin, int end) {
    if (!layout_.holds(at)) return;
    const VoxCell* row = &layout_.cells[layout_.cellIndex({at.x(), at.y(), layout_.low.z()})];
    for (int k = begin; k < end; ++k)
      if (row[k].brick == nullptr && (k == begin || row[k - 1].brick != nullptr))
        waiting_.emplace_back(at.x(), at.y(), layout_.low.z() + k);
  }

  VoxLayout& layout_;
  std::vector<Index3> waiting_;
};

}  // namespace

void saturate(BrickNodes& distance_m, float band_m) {
  if (std::find(distance_m.begin(), distance_m.end(), kFar) == distance_m.end()) return;
  // Plane by plane along x, then row by row along y: both many nodes at a time.
  constexpr int kPlane = kNodes * kNodes;
  for (int x = 1; x < kNodes; ++x) takeSigns(&distance_m[x * kPlane], kPlane, kPlane, band_m);
  for (int x = kNodes - 2; x >= 0; --x) takeSigns(&distance_m[x * kPlane], kPlane, -kPlane, band_m);
  for (int x = 0; x < kNodes; ++x) {
    for (int y = 1; y < kNodes; ++y) takeSigns(&distance_m[nodeIndex(x, y, 0)], kNodes, kNodes, band_m);
    for (int y = kNodes - 2; y >= 0; --y) takeSigns(&distance_m[nodeIndex(x, y, 0)], kNodes, -kNodes, band_m);
  }
  // Now a plane across z is known whole, or not at all.
  for (int z = 1; z < kNodes; ++z) {
    if (distance_m[z] != kFar || distance_m[z - 1] == kFar) continue;
    for (int i = z; i < kBrickNodes; i += kNodes) takeSigns(&distance_m[i], 1, 1, band_m);
  }
  for (int z = kNodes - 2; z >= 0; --z) {
    if (distance_m[z] != kFar || distance_m[z + 1] == kFar) continue;
    for (int i = z; i < kBrickNodes; i += kNodes) takeSigns(&distance_m[i], 1, -1, band_m);
  }
}

void BrickWriter::take(std::size_t count) {
  auto pool = std::make_shared<VoxPool>();
  pool->bricks.resize(count);
  layout_.pools.push_back(pool);
  bricks_ = pool->bricks.data();
}

void BrickWriter::write(std::size_t slot, std::size_t cell, BrickNodes& distance_m) {
  saturate(distance_m, band_m_);
  bricks_[slot].distance_m = distance_m;
  layout_.cells[cell].brick = &bricks_[slot];
}

void fillEmptyCells(VoxLayout& layout) {
  Filler(layout).run();
}

std::shared_ptr<const VoxPool> constantBricks(double band_m) {
  auto pool = std::make_shared<VoxPool>();
  pool->bricks.resize(2);
  pool->bricks[0].distance_m.fill(static_cast<float>(band_m));
  pool->bricks[1].distance_m.fill(-static_cast<float>(band_m));
  return pool;
}

void assembleBricks(VoxLayout& layout, const NodeBlocks& blocks) {
  Assembler assembler(layout, blocks);
  assembler.makeBricks();
  fillEmptyCells(layout);
}

}  // namespace vps
