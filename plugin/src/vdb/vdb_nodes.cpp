// SPDX-License-Identifier: BSD-3-Clause
#include "vdb/vdb_grids.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "voxmap/map_limits.h"
#include "vps/errors.h"

namespace vps {
namespace {

using Accessor = openvdb::FloatGrid::ConstAccessor;
using Leaf = openvdb::FloatTree::LeafNodeType;
static_assert(Leaf::DIM == kBrick);

class Bricks {
 public:
  Bricks(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout)
      : tree_(tree), per_m_(1 / quantum_m), file_(file), layout_(layout) {}

  void run() {
    checkSize();
    layout_.resizeCells();
    findConstants();
    addBorderCells();
    const auto count =
        static_cast<std::size_t>(std::count(is_wanted_.begin(), is_wanted_.end(), std::uint8_t{1}));
    requireMemory(static_cast<double>(count) * VoxPool::kBytes, " for its bricks",
                  "resample it with larger voxels", file_);
    std::vector<std::size_t> cells;
    cells.reserve(count);
    for (std::size_t i = 0; i < is_wanted_.size(); ++i)
      if (is_wanted_[i] != 0) cells.push_back(i);
    makeBricks(cells);
  }

 private:
  void checkSize() const {
    if (layout_.size.minCoeff() <= 0)
      throw LoadError(file_, "", "the file is damaged or cut short; build it again");
    requireDirectory(layout_.size.cast<double>(), file_);
  }

  [[nodiscard]] NodeValue nodeAt(float distance_m) const {
    return nodeOf(std::clamp<double>(per_m_ * static_cast<double>(distance_m), -kFullBand, kFullBand));
  }

  /// Finds cells covered by one value; the other cells need nodes.
  void findConstants() {
    is_wanted_.assign(layout_.bricks.size(), 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, layout_.bricks.size()), [&](const auto& range) {
      Accessor accessor(tree_);
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const openvdb::Coord origin = toCoord(kBrick * layout_.cellAt(i));
        const bool has_leaf = accessor.probeConstLeaf(origin) != nullptr;
        const NodeValue node = has_leaf ? NodeValue{0} : nodeAt(accessor.getValue(origin));
        is_wanted_[i] = std::abs(node) < kFullBand;
        layout_.bricks[i] = node < 0 ? kInside : kOutside;
      }
    });
  }

  /// Adds cells at borders. A cell's last nodes are the first nodes of its neighbours; if a neighbour has
  /// another brick, the cell needs a brick too.
  void addBorderCells() {
    std::vector<std::uint8_t> is_met(is_wanted_.size(), 0);
    tbb::parallel_for(std::size_t{0}, is_met.size(), [&](std::size_t i) {
      const Index3 cell = layout_.cellAt(i);
      for (int part = 1; part < 8; ++part) {
        const Index3 next = cell + Index3(part >> 2, part >> 1 & 1, part & 1);
        if (!layout_.holds(next)) continue;
        const std::size_t other = layout_.cellIndex(next);
        if (is_wanted_[other] != 0 || layout_.bricks[other] != layout_.bricks[i]) is_met[i] = 1;
      }
    });
    for (std::size_t i = 0; i < is_met.size(); ++i) is_wanted_[i] |= is_met[i];
  }

  void makeBricks(const std::vector<std::size_t>& cells) {
    std::vector<std::uint32_t> slot(cells.size());  // first 1 if the brick is kept, later its index
    overCells(cells, [&](std::size_t i, const NodeValue* nodes) {
      const NodeValue first = nodes[0];
      const bool is_constant =
          std::abs(first) == kFullBand &&
          std::all_of(nodes, nodes + kBrickNodes, [&](NodeValue n) { return n == first; });
      slot[i] = is_constant ? 0 : 1;
      layout_.bricks[cells[i]] = first < 0 ? kInside : kOutside;
    });
    std::size_t kept = 0;
    for (std::uint32_t& s : slot)
      if (s != 0) s = static_cast<std::uint32_t>(++kept);
    layout_.pool = std::make_shared<VoxPool>(kept);
    const std::uint32_t first = layout_.pool->take(kept);
    overCells(cells, [&](std::size_t i, const NodeValue* nodes) {
      if (slot[i] == 0) return;
      const std::uint32_t brick = first + (slot[i] - 1) * kBrickStride;
      std::copy_n(nodes, kBrickStride, layout_.pool->nodes(brick));
      layout_.bricks[cells[i]] = brick;
    });
  }

  template <typename Visit>
  void overCells(const std::vector<std::size_t>& cells, Visit visit) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size()), [&](const auto& range) {
      Accessor accessor(tree_);
      NodeValue nodes[kBrickStride] = {};
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        collect(accessor, layout_.cellAt(cells[i]), nodes);
        visit(i, nodes);
      }
    });
  }

  /// Collects a brick's own nodes, and the first nodes of seven neighbours as its border.
  void collect(Accessor& accessor, const Index3& cell, NodeValue* nodes) const {
    for (int part = 0; part < 8; ++part) {
      const Index3 step(part >> 2, part >> 1 & 1, part & 1);
      const openvdb::Coord origin = toCoord(kBrick * (cell + step));
      const Leaf* leaf = accessor.probeConstLeaf(origin);
      const NodeValue constant = leaf != nullptr ? NodeValue{0} : nodeAt(accessor.getValue(origin));
      for (int x = 0; x < (step.x() ? 1 : kBrick); ++x)
        for (int y = 0; y < (step.y() ? 1 : kBrick); ++y)
          for (int z = 0; z < (step.z() ? 1 : kBrick); ++z) {
            const auto own = static_cast<openvdb::Index>((x * kBrick + y) * kBrick + z);
            nodes[nodeIndex(x + kBrick * step.x(), y + kBrick * step.y(), z + kBrick * step.z())] =
                leaf != nullptr ? nodeAt(leaf->getValue(own)) : constant;
          }
    }
  }

  const openvdb::FloatTree& tree_;
  const double per_m_;
  const std::string& file_;
  VoxLayout& layout_;
  std::vector<std::uint8_t> is_wanted_;  // by cell: needs nodes
};

}  // namespace

void layOut(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout) {
  openvdb::CoordBBox box;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) box.expand(leaf->getNodeBoundingBox());
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (!(static_cast<double>(*tile) < quantum_m * (kFullBand - 0.5))) continue;
    openvdb::CoordBBox of_tile;
    tile.getBoundingBox(of_tile);
    box.expand(of_tile);
  }
  constexpr int kMaxIndex = std::numeric_limits<int>::max() / 4;
  if (fromVdb(box.min()).minCoeff() < -kMaxIndex || fromVdb(box.max()).maxCoeff() > kMaxIndex)
    throw LoadError(file, "", "the grid lies too many voxels from its own origin; resample it");
  const auto cellOf = [](int node) { return node >= 0 ? node / kBrick : -((kBrick - 1 - node) / kBrick); };
  const Index3 low = fromVdb(box.min()).unaryExpr(cellOf), high = fromVdb(box.max()).unaryExpr(cellOf);
  layout.low = low - Index3::Constant(2);
  layout.size = high + Index3::Constant(2) - layout.low;
}

void readNodes(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout) {
  Bricks(tree, quantum_m, file, layout).run();
}

}  // namespace vps
