// SPDX-License-Identifier: BSD-3-Clause
// Two fields on one grid become one: union, min over the parts' own distances, or difference.
//
// A union does not depend on the order, to the bit: nodes, centre distances and the box are minima over the
// parts; a brick is stored where the merged nodes are not all one constant.
#include "voxmap/voxmap_merge.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "voxmap/map_limits.h"
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

NodeValue flipped(NodeValue d) {
  return static_cast<NodeValue>(-d);
}

/// A map's cells and an added field's on their way to become one.
class Merger {
 public:
  Merger(const VoxLayout& a, const AddedField& b, Combine combine, double voxel_m)
      : a_(a),
        b_(b),
        is_union_(combine == Combine::Union),
        voxel_m_(voxel_m),
        owner_offset_(static_cast<std::uint16_t>(a.parts.size())) {}

  std::shared_ptr<VoxLayout> run() {
    layOut();
    findSyncEvents();
    const std::uint32_t first = takeRoom();
    mixed_->resize(mixed_count_);
    tbb::parallel_for(std::size_t{0}, sync_events_.size(), [&](std::size_t i) {
      fill(sync_events_[i], first + static_cast<std::uint32_t>(i) * kBrickStride);
    });
    if (!mixed_->empty()) out_->owners.push_back(mixed_);
    markFarCells(*out_);
    return out_;
  }

 private:
  /// Bricks for the sync_events, in a's own pool if it has room: the first's name.
  std::uint32_t takeRoom() {
    out_->pool = a_.pool;
    out_->owners = a_.owners;
    out_->leases = a_.leases;
    const auto kept = std::count_if(out_->bricks.begin(), out_->bricks.end(),
                                    [](std::uint32_t brick) { return !isConstant(brick); });
    requireMemory((static_cast<double>(kept) + static_cast<double>(sync_events_.size())) * VoxPool::kBytes,
                  " for its bricks", "larger voxels would do");
    const std::uint32_t first = takeBricks(*out_, sync_events_.size());
    if (first != 0)
      out_->leases.push_back(std::make_shared<BrickLease>(out_->pool, first, sync_events_.size()));
    return first;
  }

  /// A cell that gets a new brick.
  struct SyncEvent {
    std::size_t cell = 0;  ///< in the result's directory
    std::size_t cell_of_b = 0;
    std::size_t mixed = SIZE_MAX;  ///< its owners, where both fields have bricks
  };

  /// Over both; a difference has a's. A directory without cells lies nowhere, whatever its `low` says.
  [[nodiscard]] VoxPartRange rangeOfBoth() const {
    const VoxPartRange a = {{}, a_.low, a_.low + a_.size}, b = {{}, b_.low, b_.low + b_.size};
    if (!is_union_ || b_.size.minCoeff() == 0) return a;
    if (a_.size.minCoeff() == 0) return b;
    return {{}, a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
  }

  /// The directory over both (a difference has a's), filled with a's cells and with bounds from the parts'
  /// boxes.
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
    out_->centers_m[cell] = is_union_ ? std::min(from_a, from_b) : std::max(from_a, -from_b);
  }

  /// Settles the cells where one field is constant and wins; lists the others.
  void findSyncEvents() {
    const Index3 low = b_.low.cwiseMax(out_->low);
    const Index3 high = (b_.low + b_.size).cwiseMin(out_->low + out_->size);
    const std::uint32_t wins = is_union_ ? kInside : kOutside, yields = is_union_ ? kOutside : kInside;
    for (int x = low.x(); x < high.x(); ++x)
      for (int y = low.y(); y < high.y(); ++y)
        for (int z = low.z(); z < high.z(); ++z) {
          const Index3 at(x, y, z);
          SyncEvent sync_event{out_->cellIndex(at), b_.cellIndex(at), SIZE_MAX};
          std::uint32_t& brick = out_->bricks[sync_event.cell];
          const std::uint32_t kind = b_.kinds[sync_event.cell_of_b];
          if (brick == wins || kind == kOutside) continue;
          if (kind == kInside) {
            brick = wins;
            continue;
          }
          if (brick != yields || b_.hasMixedOwners(sync_event.cell_of_b)) sync_event.mixed = mixed_count_++;
          sync_events_.push_back(sync_event);
        }
  }

  void fill(const SyncEvent& sync_event, std::uint32_t brick) {
    VoxPool& pool = *out_->pool;
    const std::uint32_t old = out_->bricks[sync_event.cell];
    const NodeValue* old_nodes = pool.nodes(old);
    NodeValue* nodes = pool.nodes(brick);
    b_.write(sync_event.cell_of_b, nodes);
    if (!is_union_) std::transform(nodes, nodes + kBrickStride, nodes, flipped);
    pool.owner(brick) = static_cast<std::uint16_t>(b_.ownerOf(sync_event.cell_of_b, 0) + owner_offset_);
    out_->bricks[sync_event.cell] = brick;
    if (sync_event.mixed == SIZE_MAX) return;

    NodeOwners& owners = (*mixed_)[sync_event.mixed];
    const bool has_one_owner = !b_.hasMixedOwners(sync_event.cell_of_b);
    const std::uint16_t owner = pool.owner(brick);
    bool is_won = true;
    for (int i = 0; i < kBrickNodes; ++i) {
      const bool takes_old = is_union_ ? old_nodes[i] <= nodes[i] : old_nodes[i] >= nodes[i];
      owners[i] = takes_old ? pool.ownerOf(old, i)
                  : has_one_owner
                      ? owner
                      : static_cast<std::uint16_t>(b_.ownerOf(sync_event.cell_of_b, i) + owner_offset_);
      if (takes_old) nodes[i] = old_nodes[i];
      is_won = is_won && nodes[i] == (is_union_ ? -kFullBand : kFullBand);
    }
    pool.mixed(brick) = &owners;
    if (is_won) out_->bricks[sync_event.cell] = is_union_ ? kInside : kOutside;
  }

  const VoxLayout& a_;
  const AddedField& b_;
  const bool is_union_;
  const double voxel_m_;
  const std::uint16_t owner_offset_;
  std::shared_ptr<VoxLayout> out_ = std::make_shared<VoxLayout>();
  std::vector<SyncEvent> sync_events_;
  std::size_t mixed_count_ = 0;
  std::shared_ptr<std::vector<NodeOwners>> mixed_ = std::make_shared<std::vector<NodeOwners>>();
};

/// A field that is a map on the same grid.
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

void requireSameGrid(const VoxMap& a, const VoxMap& b) {
  if (a.voxel_m() != b.voxel_m() || a.quantum_m() != b.quantum_m())
    throw LoadError("", "",
                    "two voxmaps of different voxel size or band cannot be combined; resample one onto the "
                    "other's grid");
}

}  // namespace

VoxMap VoxMapBuilder::combined(const VoxMap& a, const AddedField& b, const Box& bounds_of_b,
                               Combine combine) {
  VoxMap out = a;
  if (combine == Combine::Union) {
    out.bounds_.add(bounds_of_b.min);
    out.bounds_.add(bounds_of_b.max);
  }
  out.layout_ = Merger(*a.layout_, b, combine, a.voxel_m_).run();
  return out;
}

VoxMap VoxMapBuilder::combined(const VoxMap& a, const VoxMap& b, Combine combine) {
  requireSameGrid(a, b);
  return combined(a, AddedMap(*b.layout_), b.bounds_, combine);
}

/// The same map with its bricks close together: merging leaves bricks behind that nothing names any more.
VoxMap VoxMapBuilder::packed(const VoxMap& map) {
  auto layout = std::make_shared<VoxLayout>(*map.layout_);
  moveToNewPool(*layout, 0);
  VoxMap out = map;
  out.layout_ = layout;
  return out;
}

VoxMap unionOf(const VoxMap& a, const VoxMap& b) {
  return VoxMapBuilder::combined(a, b, Combine::Union);
}

VoxMap differenceOf(const VoxMap& a, const VoxMap& b) {
  return VoxMapBuilder::combined(a, b, Combine::Difference);
}

VoxMap cookVoxMap(const std::vector<PlacedMesh>& parts, const VoxMapSettings& settings,
                  const Progress& progress) {
  if (parts.empty()) throw LoadError("", "", "no parts to cook into one voxmap; give at least one");
  VoxMap cooked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (progress) progress("cooking", static_cast<double>(i) / static_cast<double>(parts.size()));
    requirePose(parts[i].X_MP);
    const VoxMap map = buildVoxMap(transformed(*parts[i].mesh, parts[i].X_MP), settings);
    cooked = i == 0 ? map : unionOf(cooked, map);
  }
  if (progress) progress("cooking", 1);
  return parts.size() > 1 ? VoxMapBuilder::packed(cooked) : cooked;
}

VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMesh& part) {
  requirePose(part.X_MP);
  const VoxMapSettings settings = {cooked.voxel_m(), cooked.band_m() / cooked.voxel_m()};
  return unionOf(cooked, buildVoxMap(transformed(*part.mesh, part.X_MP), settings));
}

}  // namespace vps
