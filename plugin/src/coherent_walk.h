// SPDX-License-Identifier: BSD-3-Clause
// Which leaves a query reads: all, those that the spheres cannot exclude, or those that may have come near
// since the last pose.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "leaf_walk.h"
#include "vps/query.h"
#include "vps/query_memory.h"

namespace vps {

/// The walk that remembers; see QueryMemory. Lengths are in voxels.
template <typename Consume>
class CoherentWalk {
 public:
  CoherentWalk(const Reading& reading, const Pose& X_MP, double cutoff, QueryMemory& memory,
               Consume consume) noexcept
      : reading_(reading),
        memory_(memory),
        cutoff_(cutoff),
        error_(reading.field.error),
        beyond_(cutoff + error_ < reading.field.band ? cutoff + error_
                                                     : reading.field.band + reading.field.diagonal),
        turn_(X_MP.R - memory.X_MP_.R),
        shift_(X_MP.p - memory.X_MP_.p),
        // The largest singular value: a difference of rotations has two equal ones and a zero.
        turn_norm_(turn_.norm() * (0.70710678118654757 * (1 + 1e-6)) + 1e-15),
        reader_(reading, Reader{this, consume}) {}

  /// Before a pose's first group: with another cutoff than before the memory starts anew.
  static void begin(QueryMemory& memory, double cutoff, const Pose& X_MP) noexcept {
    if (memory.cutoff_ == cutoff) return;
    memory.clear();
    memory.cutoff_ = cutoff;
    memory.X_MP_ = X_MP;
  }
  /// After its last.
  static void end(QueryMemory& memory, const Pose& X_MP) noexcept { memory.X_MP_ = X_MP; }

  /// Threads may visit different groups at once. Every leaf taken has been read on return from flush().
  void visit(std::size_t group) noexcept { visitGroup(group); }
  void flush() noexcept { reader_.flush(); }
  [[nodiscard]] std::size_t pointsRead() const noexcept { return reader_.pointsRead(); }

 private:
  /// What positions, readings and sums are rounded by at most, generously: it only costs a little culling.
  static constexpr double kRounding = 3e-4;

  struct Reader {
    CoherentWalk* self;
    Consume consume;
    void operator()(const ReadLeaf& leaf) {
      self->note(leaf);
      consume(leaf);
    }
  };

  void visitGroup(std::size_t g) noexcept {
    QueryMemory::Group& group = memory_.groups_[g];
    const double moved_m = (turn_ * group.center + shift_).norm() + turn_norm_ * group.radius_m;
    group.way += moved_m / reading_.field.voxel_m * (1 + 1e-9);
    if (group.way < group.next) return;
    const std::size_t leaves = memory_.leaf_next_.size(), first = g * kGroupLeaves;
    double next = std::numeric_limits<double>::infinity();
    for (std::size_t leaf = first; leaf < std::min(leaves, first + kGroupLeaves); leaf += kLanes) {
      double& row_next = memory_.row_next_[leaf / kLanes];
      if (group.way >= row_next) row_next = visitRow(leaf, group.way);
      next = std::min(next, row_next);
    }
    group.next = next;
  }

  /// Up to sixteen leaves; returns when to look at them again.
  double visitRow(std::size_t first, double way) noexcept {
    const std::size_t count = std::min<std::size_t>(kLanes, memory_.leaf_next_.size() - first);
    bool has_spheres = false;
    SphereBounds bounds;
    double next = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      double& leaf_next = memory_.leaf_next_[first + i];
      if (way >= leaf_next) {
        if (!memory_.is_near_[first + i]) {
          if (!has_spheres) boundRow(first, bounds);
          has_spheres = true;
          leaf_next = way + static_cast<double>(bounds.free[i]) - kRounding;
        }
        if (way >= leaf_next) {
          leaf_next = way;
          reader_.add(static_cast<std::uint32_t>(first + i));
        }
      }
      next = std::min(next, leaf_next);
    }
    return next;
  }

  void boundRow(std::size_t first, SphereBounds& bounds) const noexcept {
    const auto& shell = reading_.shell;
    const auto cutoff = static_cast<float>(cutoff_);
    const std::size_t parent = shell.leaf_blocks + first / kLanes;
    if (parent < shell.blocks.size()) {
      reading_.kernels.bound(reading_.field, reading_.motion, shell.blocks[parent], cutoff, bounds);
      return;
    }
    // A shell of one leaf has no block above it.
    std::fill_n(bounds.free, kLanes, -1.0f);
  }

  /// After a read: how far the leaf may go. A reading that is all band says what a bound says.
  void note(const ReadLeaf& leaf) noexcept {
    const double least = static_cast<double>(leaf.least()) * reading_.field.quantum;
    double free = (least - cutoff_) / reading_.field.slope;
    if (reading_.field.is_metric) free = std::max(free, least - error_ - beyond_);
    double& leaf_next = memory_.leaf_next_[leaf.index];
    const double way = memory_.groups_[leaf.index / kGroupLeaves].way;
    // A leaf may be read in pieces: the first sets, the others lower.
    const double until = way + std::max(0.0, free - kRounding);
    leaf_next = leaf.index == noted_ ? std::min(leaf_next, until) : until;
    noted_ = leaf.index;
    memory_.is_near_[leaf.index] =
        free * reading_.field.voxel_m < leaf.block.radius_m || leaf.block.count == 1;
    double& row_next = memory_.row_next_[leaf.index / kLanes];
    row_next = std::min(row_next, leaf_next);
  }

  const Reading& reading_;
  QueryMemory& memory_;
  const double cutoff_;
  const double error_;   ///< of the field against true distances: half a cell's diagonal, and a quantum
  const double beyond_;  ///< a true distance above this gives readings above the cutoff
  const Mat3 turn_;      // since the last pose
  const Vec3 shift_;
  const double turn_norm_;
  std::uint32_t noted_ = UINT32_MAX;
  LeafReader<Reader> reader_;
};

/// The memory, if it is of this pair.
inline QueryMemory* usable(QueryMemory* memory, const VoxMap& map, const PointShell& shell) noexcept {
  return memory != nullptr && memory->isFor(map, shell) ? memory : nullptr;
}

/// Calls consume(const ReadLeaf&), in ascending order, for every leaf that may have a point within the
/// cutoff; returns a bound [voxels] that the points of the others are not below.
template <typename Consume>
double readNearLeaves(const Reading& reading, const Pose& X_MP, const QueryOptions& options, double cutoff_m,
                      QueryMemory* memory, std::size_t& points_read, Consume consume) noexcept {
  const double cutoff = cutoff_m / reading.field.voxel_m;
  double least = std::numeric_limits<double>::infinity();
  if (reading.shell.leaf_blocks == 0) return least;
  if (memory != nullptr && !options.is_exhaustive) {
    using Walk = CoherentWalk<Consume>;
    Walk::begin(*memory, cutoff, X_MP);
    Walk walk(reading, X_MP, cutoff, *memory, consume);
    for (std::size_t g = 0; g < groupCount(reading.shell); ++g) walk.visit(g);
    walk.flush();
    Walk::end(*memory, X_MP);
    points_read = walk.pointsRead();
    return cutoff;
  }
  LeafReader<Consume> reader(reading, consume);
  if (options.is_exhaustive)
    for (std::uint32_t leaf = 0; leaf < reading.shell.leaf_blocks; ++leaf) reader.add(leaf);
  else
    least = walkNear(reading, static_cast<std::uint32_t>(reading.shell.blocks.size() - 1),
                     static_cast<float>(cutoff), [&](std::uint32_t leaf) { reader.add(leaf); });
  reader.flush();
  points_read = reader.pointsRead();
  return least;
}

/// The same for one group, for threads that share a query. With a memory, begin() and end() are the caller's.
template <typename Consume>
double readNearLeavesOf(std::size_t group, const Reading& reading, const Pose& X_MP,
                        const QueryOptions& options, double cutoff_m, QueryMemory* memory,
                        std::size_t& points_read, Consume consume) noexcept {
  const double cutoff = cutoff_m / reading.field.voxel_m;
  if (memory != nullptr && !options.is_exhaustive) {
    CoherentWalk<Consume> walk(reading, X_MP, cutoff, *memory, consume);
    walk.visit(group);
    walk.flush();
    points_read = walk.pointsRead();
    return cutoff;
  }
  double least = std::numeric_limits<double>::infinity();
  LeafReader<Consume> reader(reading, consume);
  const std::size_t end = std::min(reading.shell.leaf_blocks, (group + 1) * kGroupLeaves);
  if (options.is_exhaustive)
    for (std::size_t leaf = group * kGroupLeaves; leaf < end; ++leaf)
      reader.add(static_cast<std::uint32_t>(leaf));
  else
    least = walkNear(reading, groupRoot(reading.shell, group), static_cast<float>(cutoff),
                     [&](std::uint32_t leaf) { reader.add(leaf); });
  reader.flush();
  points_read = reader.pointsRead();
  return least;
}

/// The result's distance, from the least reading [quanta] and what the points left out are not below
/// [voxels].
inline void setDistance(const VoxMap& map, const Reading& reading, float least_read, double least_skipped,
                        QueryResult& result) noexcept {
  const double read_m = reading.field.quantum_m * least_read;
  // Where nothing is left out both are infinite; saturated bounds were rounded to floats.
  const double skipped_m = std::isfinite(least_skipped)
                               ? std::min(map.band_m(), reading.field.voxel_m * least_skipped)
                               : least_skipped;
  result.min_distance_m = std::min(read_m, skipped_m);
  result.is_beyond_band = skipped_m < read_m || !(read_m < map.band_m());
}

}  // namespace vps
