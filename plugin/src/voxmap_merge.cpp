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

/// The pool that takes `count` bricks more: a's own if it has room, else a copy with room for as many again,
/// so that mounting one part after another copies each brick a few times at most.
std::shared_ptr<VoxPool> poolWithRoom(const std::shared_ptr<VoxPool>& pool, std::size_t count,
                                      std::uint32_t& first) {
  if (count == 0) return pool;
  first = pool->take(count);
  if (first != 0) return pool;
  const std::size_t old_count = pool->size();
  auto larger = std::make_shared<VoxPool>(2 * (old_count + count));
  (void)larger->take(old_count - 2);
  std::copy_n(pool->nodes(0), old_count * kBrickStride, larger->nodes(0));
  for (std::uint32_t brick = kInside + kBrickStride; brick < old_count * kBrickStride;
       brick += kBrickStride) {
    larger->owner(brick) = pool->owner(brick);
    larger->mixed(brick) = pool->mixed(brick);
  }
  first = larger->take(count);
  return larger;
}

/// Two maps' cells and bricks on their way to become one.
class Merger {
 public:
  Merger(const VoxLayout& a, const VoxLayout& b, double voxel_m)
      : a_(a), b_(b), voxel_m_(voxel_m), owner_offset_(static_cast<std::uint16_t>(a.parts.size())) {}

  std::shared_ptr<VoxLayout> run() {
    layOut();
    std::size_t new_bricks = 0, mixed_bricks = 0;
    forEachCellOfB([&](std::uint32_t old, std::uint32_t added) {
      if (old == kInside || isConstant(added)) return;
      ++new_bricks;
      mixed_bricks += old != kOutside || b_.pool->mixed(added) != nullptr;
    });
    out_->pool = poolWithRoom(a_.pool, new_bricks, next_);
    mixed_->reserve(mixed_bricks);  // bricks point into it
    forEachCellOfB([&](std::uint32_t& brick, std::uint32_t added) { brick = mergedBrick(brick, added); });
    if (!mixed_->empty()) out_->owners.push_back(mixed_);
    return out_;
  }

 private:
  /// The directory over both, filled with a's cells and with bounds from the parts' boxes.
  void layOut() {
    const Index3 low = a_.low.cwiseMin(b_.low), high = (a_.low + a_.size).cwiseMax(b_.low + b_.size);
    out_->low = low;
    out_->size = high - low;
    out_->owners = a_.owners;
    out_->parts = a_.parts;
    out_->parts.insert(out_->parts.end(), b_.parts.begin(), b_.parts.end());
    out_->resizeCells();
    for (int x = low.x(); x < high.x(); ++x)
      for (int y = low.y(); y < high.y(); ++y)
        for (int z = low.z(); z < high.z(); ++z) {
          const Index3 at(x, y, z);
          const std::size_t cell = out_->cellIndex(at);
          const bool in_a = a_.holds(at), in_b = b_.holds(at);
          if (in_a) out_->bricks[cell] = a_.bricks[a_.cellIndex(at)];
          const float from_a = in_a ? a_.centers_m[a_.cellIndex(at)] : boxBound(a_.parts, at, voxel_m_);
          const float from_b = in_b ? b_.centers_m[b_.cellIndex(at)] : boxBound(b_.parts, at, voxel_m_);
          out_->centers_m[cell] = std::min(from_a, from_b);
        }
  }

  template <typename Visit>
  void forEachCellOfB(Visit visit) {
    for (int x = 0; x < b_.size.x(); ++x)
      for (int y = 0; y < b_.size.y(); ++y)
        for (int z = 0; z < b_.size.z(); ++z) {
          const Index3 at = b_.low + Index3(x, y, z);
          visit(out_->bricks[out_->cellIndex(at)], b_.bricks[b_.cellIndex(at)]);
        }
  }

  std::uint32_t mergedBrick(std::uint32_t old, std::uint32_t added) {
    if (old == kInside || added == kOutside) return old;
    if (added == kInside) return kInside;
    VoxPool& pool = *out_->pool;
    const std::uint32_t brick = next_;
    const NodeValue *old_nodes = pool.nodes(old), *added_nodes = b_.pool->nodes(added);
    NodeValue* nodes = pool.nodes(brick);
    pool.owner(brick) = static_cast<std::uint16_t>(b_.pool->owner(added) + owner_offset_);
    pool.mixed(brick) = nullptr;
    if (old == kOutside && b_.pool->mixed(added) == nullptr) {
      std::copy_n(added_nodes, kBrickStride, nodes);
      next_ += kBrickStride;
      return brick;
    }
    std::transform(old_nodes, old_nodes + kBrickStride, added_nodes, nodes,
                   [](NodeValue a, NodeValue b) { return std::min(a, b); });
    if (std::all_of(nodes, nodes + kBrickNodes, [](NodeValue d) { return d == -kFullBand; })) return kInside;
    NodeOwners& owners = mixed_->emplace_back();
    for (int i = 0; i < kBrickNodes; ++i)
      owners[i] = old_nodes[i] <= added_nodes[i]
                      ? pool.ownerOf(old, i)
                      : static_cast<std::uint16_t>(b_.pool->ownerOf(added, i) + owner_offset_);
    pool.mixed(brick) = &owners;
    next_ += kBrickStride;
    return brick;
  }

  const VoxLayout &a_, &b_;
  const double voxel_m_;
  const std::uint16_t owner_offset_;
  std::shared_ptr<VoxLayout> out_ = std::make_shared<VoxLayout>();
  std::shared_ptr<std::vector<NodeOwners>> mixed_ = std::make_shared<std::vector<NodeOwners>>();
  std::uint32_t next_ = 0;  ///< the brick to fill next
};

}  // namespace

VoxMap VoxMapBuilder::merge(const VoxMap& a, const VoxMap& b) {
  VoxMap out = a;
  out.bounds_.add(b.bounds_.min);
  out.bounds_.add(b.bounds_.max);
  out.layout_ = Merger(*a.layout_, *b.layout_, a.voxel_m_).run();
  return out;
}

/// The same map with its bricks close together: merging leaves bricks behind that nothing names any more.
VoxMap VoxMapBuilder::packed(const VoxMap& map) {
  auto layout = std::make_shared<VoxLayout>(*map.layout_);
  const VoxPool& from = *map.layout_->pool;
  const std::size_t count = map.brickCount();
  auto pool = std::make_shared<VoxPool>(count);
  std::uint32_t next = pool->take(count);
  auto mixed = std::make_shared<std::vector<NodeOwners>>();
  mixed->reserve(static_cast<std::size_t>(
      std::count_if(layout->bricks.begin(), layout->bricks.end(),
                    [&](std::uint32_t brick) { return from.mixed(brick) != nullptr; })));
  for (std::uint32_t& brick : layout->bricks) {
    if (isConstant(brick)) continue;
    std::copy_n(from.nodes(brick), kBrickStride, pool->nodes(next));
    pool->owner(next) = from.owner(brick);
    pool->mixed(next) = from.mixed(brick) != nullptr ? &mixed->emplace_back(*from.mixed(brick)) : nullptr;
    brick = next;
    next += kBrickStride;
  }
  layout->pool = pool;
  layout->owners = {mixed};
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
