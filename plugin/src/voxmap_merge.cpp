// SPDX-License-Identifier: BSD-3-Clause
// Several parts in one voxmap: the union, min over the parts' own distances.
//
// The result does not depend on the order, to the bit: nodes, centre distances and the box are minima over
// the parts; a brick is stored where the merged nodes are not all one constant.
#include <algorithm>

#include "voxelise.h"
#include "vps/load_error.h"

namespace vps {
namespace {

double boxDistance(const Box& box, const Vec3& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
}

bool inRange(const VoxPartRange& part, const Index3& cell) {
  return (cell.array() >= part.low.array()).all() && (cell.array() < part.high.array()).all();
}

/// A lower bound of the distance from a cell's centre to the parts for which the directory has nothing
/// better: those whose own range does not hold the cell. As float, rounded towards zero, so that it stays a
/// bound.
float boxBound(const std::vector<VoxPartRange>& parts, const Index3& cell, double voxel_m) {
  const Vec3 center = voxel_m * (VoxMap::kBrick * cell + Index3::Constant(VoxMap::kBrick / 2)).cast<double>();
  double least_m = 1e30;
  for (const VoxPartRange& part : parts)
    if (!inRange(part, cell)) least_m = std::min(least_m, boxDistance(part.bounds, center));
  return static_cast<float>(least_m * (1 - 2e-7));
}

/// Two maps' cells and bricks on their way to become one.
class Merger {
 public:
  Merger(const VoxLayout& a, const VoxLayout& b, double voxel_m)
      : a_(a), b_(b), voxel_m_(voxel_m), owner_offset_(static_cast<std::uint16_t>(a.parts.size())) {}

  std::shared_ptr<VoxLayout> run() {
    layOut();
    std::size_t new_bricks = 0, mixed_bricks = 0;
    forEachCellOfB([&](const VoxCell& old, const VoxCell& added) {
      if (old.brick == a_.inside() || b_.isConstant(added.brick)) return;
      ++new_bricks;
      mixed_bricks += old.brick != a_.outside() || added.brick->owners != nullptr;
    });
    // Cells point into the pool, so it must not grow later.
    pool_->bricks.reserve(new_bricks);
    pool_->owners.reserve(mixed_bricks);
    forEachCellOfB(
        [&](VoxCell& cell, const VoxCell& added) { cell.brick = mergedBrick(cell.brick, added.brick); });
    if (!pool_->bricks.empty()) out_->pools.push_back(pool_);
    return out_;
  }

 private:
  /// The directory over both, filled with a's cells and with bounds from the parts' boxes.
  void layOut() {
    const Index3 low = a_.low.cwiseMin(b_.low), high = (a_.low + a_.size).cwiseMax(b_.low + b_.size);
    out_->low = low;
    out_->size = high - low;
    out_->constants = a_.constants;
    out_->pools = a_.pools;
    out_->parts = a_.parts;
    out_->parts.insert(out_->parts.end(), b_.parts.begin(), b_.parts.end());
    out_->cells.resize(static_cast<std::size_t>(out_->size.cast<std::int64_t>().prod()));
    for (int x = low.x(); x < high.x(); ++x)
      for (int y = low.y(); y < high.y(); ++y)
        for (int z = low.z(); z < high.z(); ++z) {
          const Index3 at(x, y, z);
          VoxCell& cell = out_->cells[out_->cellIndex(at)];
          const bool in_a = a_.holds(at), in_b = b_.holds(at);
          cell.brick = in_a ? a_.cells[a_.cellIndex(at)].brick : a_.outside();
          const float from_a = in_a ? a_.cells[a_.cellIndex(at)].center_m : boxBound(a_.parts, at, voxel_m_);
          const float from_b = in_b ? b_.cells[b_.cellIndex(at)].center_m : boxBound(b_.parts, at, voxel_m_);
          cell.center_m = std::min(from_a, from_b);
        }
  }

  template <typename Visit>
  void forEachCellOfB(Visit visit) {
    for (int x = 0; x < b_.size.x(); ++x)
      for (int y = 0; y < b_.size.y(); ++y)
        for (int z = 0; z < b_.size.z(); ++z) {
          const Index3 at = b_.low + Index3(x, y, z);
          visit(out_->cells[out_->cellIndex(at)], b_.cells[b_.cellIndex(at)]);
        }
  }

  const VoxBrick* mergedBrick(const VoxBrick* old, const VoxBrick* added) {
    if (old == a_.inside() || added == b_.outside()) return old;
    if (added == b_.inside()) return a_.inside();
    VoxBrick& brick = pool_->bricks.emplace_back(*added);
    brick.owner = static_cast<std::uint16_t>(added->owner + owner_offset_);
    if (old == a_.outside() && added->owners == nullptr) return &brick;

    auto& owners = pool_->owners.emplace_back();
    brick.owners = owners.data();
    const float inside_m = a_.inside()->distance_m[0];
    bool is_all_inside = true;
    for (int i = 0; i < kBrickNodes; ++i) {
      const bool takes_old = old->distance_m[i] <= added->distance_m[i];
      brick.distance_m[i] = std::min(old->distance_m[i], added->distance_m[i]);
      owners[i] =
          takes_old ? ownerOf(*old, i) : static_cast<std::uint16_t>(ownerOf(*added, i) + owner_offset_);
      is_all_inside = is_all_inside && brick.distance_m[i] == inside_m;
    }
    if (!is_all_inside) return &brick;
    pool_->bricks.pop_back();
    pool_->owners.pop_back();
    return a_.inside();
  }

  static std::uint16_t ownerOf(const VoxBrick& brick, int node) {
    return brick.owners != nullptr ? brick.owners[node] : brick.owner;
  }

  const VoxLayout &a_, &b_;
  const double voxel_m_;
  const std::uint16_t owner_offset_;
  std::shared_ptr<VoxLayout> out_ = std::make_shared<VoxLayout>();
  std::shared_ptr<VoxPool> pool_ = std::make_shared<VoxPool>();
};

}  // namespace

VoxMap VoxMapBuilder::merge(const VoxMap& a, const VoxMap& b) {
  VoxMap out = a;
  out.bounds_.add(b.bounds_.min);
  out.bounds_.add(b.bounds_.max);
  out.layout_ = Merger(*a.layout_, *b.layout_, a.voxel_m_).run();
  return out;
}

/// The same map with all its bricks in one pool: merging leaves bricks behind that nothing points to any
/// more.
VoxMap VoxMapBuilder::packed(const VoxMap& map) {
  auto layout = std::make_shared<VoxLayout>(*map.layout_);
  auto pool = std::make_shared<VoxPool>();
  std::size_t bricks = 0, mixed = 0;
  for (const VoxCell& cell : layout->cells) {
    if (layout->isConstant(cell.brick)) continue;
    ++bricks;
    mixed += cell.brick->owners != nullptr;
  }
  pool->bricks.reserve(bricks);
  pool->owners.reserve(mixed);
  for (VoxCell& cell : layout->cells) {
    if (layout->isConstant(cell.brick)) continue;
    VoxBrick& brick = pool->bricks.emplace_back(*cell.brick);
    if (brick.owners != nullptr) {
      auto& owners = pool->owners.emplace_back();
      std::copy_n(brick.owners, kBrickNodes, owners.begin());
      brick.owners = owners.data();
    }
    cell.brick = &brick;
  }
  layout->pools = {pool};
  VoxMap out = map;
  out.layout_ = layout;
  return out;
}

VoxMap cookVoxMap(const std::vector<PlacedMesh>& parts, const VoxMapSettings& settings,
                  const Progress& progress) {
  if (parts.empty()) throw LoadError("", "", "no parts to cook into one voxmap; give at least one");
  VoxMap cooked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (progress) progress("cooking", static_cast<double>(i) / static_cast<double>(parts.size()));
    const VoxMap map = buildVoxMap(transformed(*parts[i].mesh, parts[i].X_MP), settings);
    cooked = i == 0 ? map : VoxMapBuilder::merge(cooked, map);
  }
  if (progress) progress("cooking", 1);
  return parts.size() > 1 ? VoxMapBuilder::packed(cooked) : cooked;
}

VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMesh& part) {
  const VoxMapSettings settings = {cooked.voxel_m(), cooked.band_m() / cooked.voxel_m()};
  return VoxMapBuilder::merge(cooked, buildVoxMap(transformed(*part.mesh, part.X_MP), settings));
}

}  // namespace vps
