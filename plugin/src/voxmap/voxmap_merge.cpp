// SPDX-License-Identifier: BSD-3-Clause
// Merges two fields on one grid into their union: the minimum of the parts' own distances.
//
// The union does not depend on the order, to the bit: nodes, centre distances and the box are minima over the
// parts, and a cell stores a brick unless its merged nodes are all one constant.
#include "voxmap/voxmap_access.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "voxmap/map_limits.h"
#include "vps/errors.h"

namespace vps {
namespace {

double boxDistance(const Box& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

bool inRange(const VoxPartRange& part, const Index3& cell) {
  return (cell.array() >= part.low.array()).all() && (cell.array() < part.high.array()).all();
}

/// A lower bound of the distance from a cell's centre to the parts whose own range does not contain the cell;
/// for the other parts the directories have better bounds. The bound is rounded towards zero when converted
/// to float, so that it stays a bound.
float boxBound(const std::vector<VoxPartRange>& parts, const Index3& cell, double voxel_m) {
  const Vec3 center = voxel_m * (VoxMap::kBrick * cell + Index3::Constant(VoxMap::kBrick / 2)).cast<double>();
  double least_m = 1e30;
  for (const VoxPartRange& part : parts)
    if (!inRange(part, cell)) least_m = std::min(least_m, boxDistance(part.bounds, center));
  return static_cast<float>(least_m * (1 - 2e-7));
}

/// Merges the cells of a map with the cells of an added field.
class Merger {
 public:
  Merger(const VoxLayout& a, const AddedField& b, double voxel_m)
      : a_(a), b_(b), voxel_m_(voxel_m), owner_offset_(static_cast<std::uint16_t>(a.parts.size())) {}

  std::shared_ptr<VoxLayout> run() {
    layOut();
    findNewBricks();
    const std::uint32_t first = takeRoom();
    mixed_->resize(mixed_count_);
    tbb::parallel_for(std::size_t{0}, new_bricks_.size(), [&](std::size_t i) {
      fill(new_bricks_[i], first + static_cast<std::uint32_t>(i) * kBrickStride);
    });
    if (!mixed_->empty()) out_->owners.push_back(mixed_);
    markFarCells(*out_);
    return out_;
  }

 private:
  /// Allocates the new bricks, in the pool of a_ if it has room; returns the first one's name.
  std::uint32_t takeRoom() {
    out_->pool = a_.pool;
    out_->owners = a_.owners;
    out_->leases = a_.leases;
    const auto kept = std::count_if(out_->bricks.begin(), out_->bricks.end(),
                                    [](std::uint32_t brick) { return !isConstant(brick); });
    requireMemory((static_cast<double>(kept) + static_cast<double>(new_bricks_.size())) * VoxPool::kBytes,
                  " for its bricks", "use larger voxels");
    const std::uint32_t first = takeBricks(*out_, new_bricks_.size());
    if (first != 0)
      out_->leases.push_back(std::make_shared<BrickLease>(out_->pool, first, new_bricks_.size()));
    return first;
  }

  /// A cell that gets a new brick.
  struct NewBrick {
    std::size_t cell = 0;  ///< in the result's directory
    std::size_t cell_of_b = 0;
    std::size_t mixed = SIZE_MAX;  ///< index of its owners, if both fields have bricks there
  };

  /// The range that covers both fields. A directory without cells has no position, whatever its `low` is.
  [[nodiscard]] VoxPartRange rangeOfBoth() const {
    const VoxPartRange a = {{}, a_.low, a_.low + a_.size}, b = {{}, b_.low, b_.low + b_.size};
    if (b_.size.minCoeff() == 0) return a;
    if (a_.size.minCoeff() == 0) return b;
    return {{}, a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
  }

  /// Creates the directory over both fields, with the cells of a_ and with bounds from the parts' boxes.
  void layOut() {
    const VoxPartRange range = rangeOfBoth();
    const Index3 low = range.low, high = range.high;
    requireDirectory(high.cast<double>() - low.cast<double>());
    out_->low = low;
    out_->size = high - low;
    out_->parts = a_.parts;
    out_->parts.insert(out_->parts.end(), b_.parts.begin(), b_.parts.end());
    out_->steepest = std::max(a_.steepest, b_.steepest);
    out_->node_error = std::max(a_.node_error, b_.node_error);
    out_->is_metric = a_.is_metric && b_.is_metric;
    out_->resizeCells();
    tbb::parallel_for(low.x(), high.x(), [&](int x) {
      for (int y = low.y(); y < high.y(); ++y)
        for (int z = low.z(); z < high.z(); ++z) layOutCell(Index3(x, y, z));
    });
  }

  void layOutCell(const Index3& at) {
    const std::size_t cell = out_->cellIndex(at);
    const bool in_a = a_.holds(at), in_b = b_.holds(at);
    if (in_a) out_->bricks[cell] = a_.bricks[a_.cellIndex(at)];
    const float from_a = in_a ? a_.centers_m[a_.cellIndex(at)] : boxBound(a_.parts, at, voxel_m_);
    const float from_b = in_b ? b_.centers_m[b_.cellIndex(at)] : boxBound(b_.parts, at, voxel_m_);
    out_->centers_m[cell] = std::min(from_a, from_b);
  }

  /// Decides the cells where one field is constant; lists the other cells.
  void findNewBricks() {
    const Index3 low = b_.low.cwiseMax(out_->low);
    const Index3 high = (b_.low + b_.size).cwiseMin(out_->low + out_->size);
    for (int x = low.x(); x < high.x(); ++x)
      for (int y = low.y(); y < high.y(); ++y)
        for (int z = low.z(); z < high.z(); ++z) {
          const Index3 at(x, y, z);
          NewBrick added{out_->cellIndex(at), b_.cellIndex(at), SIZE_MAX};
          std::uint32_t& brick = out_->bricks[added.cell];
          const std::uint32_t kind = b_.kinds[added.cell_of_b];
          if (brick == kInside || kind == kOutside) continue;
          if (kind == kInside) {
            brick = kInside;
            continue;
          }
          if (brick != kOutside || b_.hasMixedOwners(added.cell_of_b)) added.mixed = mixed_count_++;
          new_bricks_.push_back(added);
        }
  }

  void fill(const NewBrick& added, std::uint32_t brick) {
    VoxPool& pool = *out_->pool;
    const std::uint32_t old = out_->bricks[added.cell];
    const NodeValue* old_nodes = pool.nodes(old);
    NodeValue* nodes = pool.nodes(brick);
    b_.write(added.cell_of_b, nodes);
    pool.owner(brick) = static_cast<std::uint16_t>(b_.ownerOf(added.cell_of_b, 0) + owner_offset_);
    out_->bricks[added.cell] = brick;
    if (added.mixed == SIZE_MAX) return;

    NodeOwners& owners = (*mixed_)[added.mixed];
    const bool has_one_owner = !b_.hasMixedOwners(added.cell_of_b);
    const std::uint16_t owner = pool.owner(brick);
    bool is_won = true;
    for (int i = 0; i < kBrickNodes; ++i) {
      const bool takes_old = old_nodes[i] <= nodes[i];
      owners[i] = takes_old ? pool.ownerOf(old, i)
                  : has_one_owner
                      ? owner
                      : static_cast<std::uint16_t>(b_.ownerOf(added.cell_of_b, i) + owner_offset_);
      if (takes_old) nodes[i] = old_nodes[i];
      is_won = is_won && nodes[i] == -kFullBand;
    }
    pool.mixed(brick) = &owners;
    if (is_won) out_->bricks[added.cell] = kInside;
  }

  const VoxLayout& a_;
  const AddedField& b_;
  const double voxel_m_;
  const std::uint16_t owner_offset_;
  std::shared_ptr<VoxLayout> out_ = std::make_shared<VoxLayout>();
  std::vector<NewBrick> new_bricks_;
  std::size_t mixed_count_ = 0;
  std::shared_ptr<std::vector<NodeOwners>> mixed_ = std::make_shared<std::vector<NodeOwners>>();
};

/// A map on the same grid in the form of an added field.
class AddedMap final : public AddedField {
 public:
  explicit AddedMap(const VoxLayout& layout) : layout_(layout) {
    low = layout.low;
    size = layout.size;
    kinds = layout.bricks;
    centers_m = layout.centers_m;
    parts = layout.parts;
    steepest = layout.steepest;
    node_error = layout.node_error;
    is_metric = layout.is_metric;
  }
  void write(std::size_t cell, NodeValue* nodes) const override {
    std::copy_n(layout_.nodesOf(cell), kBrickStride, nodes);
  }
  [[nodiscard]] std::uint16_t ownerOf(std::size_t cell, int node) const override {
    return layout_.pool->ownerOf(layout_.bricks[cell], node);
  }
  [[nodiscard]] bool hasMixedOwners(std::size_t cell) const override {
    return layout_.pool->mixed(layout_.bricks[cell]) != nullptr;
  }

 private:
  const VoxLayout& layout_;
};

}  // namespace

VoxMap mergedVoxMap(const VoxMap& a, const AddedField& b, const Box& bounds_of_b) {
  Box bounds = a.bounds();
  bounds.add(bounds_of_b.min);
  bounds.add(bounds_of_b.max);
  return VoxMapAccess::make(Merger(*VoxMapAccess::layout(a), b, a.voxel_m()).run(), a.voxel_m(), a.band_m(),
                            bounds);
}

VoxMap mergedVoxMap(const VoxMap& a, const VoxMap& b) {
  VPS_ASSERT(a.voxel_m() == b.voxel_m() && a.quantum_m() == b.quantum_m());
  return mergedVoxMap(a, AddedMap(*VoxMapAccess::layout(b)), b.bounds());
}

VoxMap packedVoxMap(const VoxMap& map) {
  auto layout = std::make_shared<VoxLayout>(*VoxMapAccess::layout(map));
  moveToNewPool(*layout, 0);
  return VoxMapAccess::make(layout, map.voxel_m(), map.band_m(), map.bounds());
}

}  // namespace vps
