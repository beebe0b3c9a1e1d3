// SPDX-License-Identifier: BSD-3-Clause
// Selects the leaves that a query reads: all leaves, leaves that spheres cannot exclude, or leaves that may
// have come near since the last pose.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "query/points/leaf_walk.h"
#include "vps/contact_tolerances.h"
#include "vps/query.h"
#include "vps/query_memory.h"

namespace vps {

/// The walk with temporal coherence; see QueryMemory. Lengths are in voxels.
template <typename Consume>
class CoherentWalk {
 public:
  CoherentWalk(const MapReading& reading, const Pose& X_MP, double cutoff, QueryMemory& memory,
               Consume consume) noexcept
      : reading_(reading),
        memory_(memory),
        cutoff_(cutoff),
        error_(reading.field.error),
        beyond_(beyond(reading, cutoff)),
        turn_(X_MP.R - memory.X_MP_.R),
        shift_(X_MP.p - memory.X_MP_.p),
        turn_norm_(largestStretch(turn_)),
        reader_(reading, Reader{this, consume}) {}

  /// Call before the first group of a pose. A leaf is read again when the odometer of its group passes the
  /// leaf's threshold. If the last cutoff was smaller, the thresholds are too great by at most the difference
  /// of the cutoffs, which is added to the odometers. If the last cutoff was larger, the thresholds are too
  /// small, which only costs readings.
  static void begin(QueryMemory& memory, const MapReading& reading, double cutoff,
                    const Pose& X_MP) noexcept {
    const double last = std::exchange(memory.cutoff_, cutoff);
    if (last == QueryMemory::kNoQuery) memory.X_MP_ = X_MP;
    if (last == QueryMemory::kNoQuery || cutoff <= last) return;
    const double shift =
        std::max((cutoff - last) / reading.field.slope, beyond(reading, cutoff) - beyond(reading, last));
    for (QueryMemory::Group& group : memory.groups_)
      group.odometer += shift * (1 + kRoundingShare) + kRoundingOfSum;
  }
  /// Call after the last group of a pose.
  static void end(QueryMemory& memory, const Pose& X_MP) noexcept { memory.X_MP_ = X_MP; }

  void visit(std::size_t group) noexcept { visitGroup(group); }
  /// When flush() returns, every visited leaf has been read.
  void flush() noexcept { reader_.flush(); }
  [[nodiscard]] std::size_t pointsRead() const noexcept { return reader_.pointsRead(); }

 private:
  /// A generous bound of the rounding errors of positions, readings and sums; it costs only a little culling.
  static constexpr double kRounding = 3e-4;
  /// The value at which odometers are reset [voxels], and half the last place of a double of that size.
  static constexpr double kFarthest = 1 << 20, kRoundingOfSum = kFarthest * 0x1p-53;
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// The true distance above which the field reads above the cutoff.
  static double beyond(const MapReading& reading, double cutoff) noexcept {
    const double least = cutoff + reading.field.error;
    return least < reading.field.band ? least : reading.field.band + reading.field.diagonal;
  }
  /// The largest singular value of a matrix, rounded up: the root of the largest eigenvalue of its square.
  /// Works for any matrix, since poses may be rotations to only a few digits.
  static double largestStretch(const Mat3& m) noexcept {
    const double scale = m.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return 0;
    const Mat3 unit = m / scale, square = unit.transpose() * unit;
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(square, Eigen::EigenvaluesOnly);
    // If the largest two eigenvalues are equal, as for a difference of rotations, both are accurate to 1e-8.
    return scale * std::sqrt(solver.eigenvalues()[2]) * (1 + 1e-6);
  }

  struct Reader {
    CoherentWalk* self;
    Consume consume;
    void operator()(const ReadLeaf& leaf) {
      self->note(leaf);
      consume(leaf);
    }
  };

  /// Visits the rows of a group that are due. When a leaf is read, now or in a later batch, note() lowers the
  /// thresholds of leaf, row and group.
  void visitGroup(std::size_t g) noexcept {
    QueryMemory::Group& group = memory_.groups_[g];
    const double moved_m = (turn_ * group.center + shift_).norm() + turn_norm_ * group.radius_m;
    // The last term bounds the rounding error of the sum, below kFarthest.
    group.odometer += moved_m / reading_.field.voxel_m * (1 + kRoundingShare) + kRoundingOfSum;
    if (!(group.odometer < kFarthest)) restart(g);
    if (group.odometer < group.next) return;
    group.next = kNever;
    openNearRows(g);
    for (std::size_t row = g * kGroupRows; row < std::min(memory_.row_next_.size(), (g + 1) * kGroupRows);
         ++row) {
      if (group.odometer >= memory_.row_next_[row]) visitRow(row, group.odometer);
      group.next = std::min(group.next, memory_.row_next_[row]);
    }
  }

  /// Rows that were never near are bounded by their own spheres, and opened when these bounds no longer
  /// suffice.
  void openNearRows(std::size_t g) noexcept {
    QueryMemory::Group& group = memory_.groups_[g];
    double* next = &memory_.row_next_[g * kGroupRows];
    std::uint32_t waiting = 0;
    for (std::uint32_t rows = group.closed; rows != 0; rows &= rows - 1) {
      const int row = std::countr_zero(rows);
      if (group.odometer >= next[row]) waiting |= 1U << row;
    }
    if (waiting == 0) return;
    SphereBounds bounds;
    boundChildren(reading_.shell.leaf_blocks + memory_.row_next_.size() + g, bounds);
    for (; waiting != 0; waiting &= waiting - 1) {
      const int row = std::countr_zero(waiting);
      next[row] = group.odometer + (static_cast<double>(bounds.free[row]) - kRounding);
      if (next[row] > group.odometer) continue;
      group.closed = static_cast<std::uint16_t>(group.closed & ~(1U << row));
      memory_.openRow(g * kGroupRows + static_cast<std::size_t>(row));
    }
  }

  /// Resets a group's odometer and tests all its leaves. A large odometer would lose small steps to rounding.
  void restart(std::size_t g) noexcept {
    memory_.groups_[g].odometer = 0;
    memory_.groups_[g].next = -1;
    const std::size_t first = g * kGroupRows, end = std::min(memory_.row_next_.size(), first + kGroupRows);
    for (std::size_t row = first; row < end; ++row) {
      const bool is_closed = (memory_.groups_[g].closed >> (row - first) & 1) != 0;
      if (is_closed)
        memory_.row_next_[row] = -1;
      else
        memory_.openRow(row);
    }
  }

  /// Tests up to sixteen leaves: leaves whose threshold has passed are read, unless the bounds of their
  /// spheres suffice.
  void visitRow(std::size_t row, double odometer) noexcept {
    double* next = &memory_.leaf_next_[row * kLanes];
    const auto due = [&] {
      std::uint32_t bits = 0;
      for (int i = 0; i < kLanes; ++i) bits |= static_cast<std::uint32_t>(odometer >= next[i]) << i;
      return bits;
    };
    std::uint32_t waiting = due();
    if ((waiting & ~std::uint32_t{memory_.row_near_[row]}) != 0) {
      SphereBounds bounds;
      boundChildren(reading_.shell.leaf_blocks + row, bounds);
      for (int i = 0; i < kLanes; ++i)
        next[i] = std::max(next[i], odometer + (static_cast<double>(bounds.free[i]) - kRounding));
      waiting = due();
    }
    memory_.row_next_[row] = kNever;
    for (; waiting != 0; waiting &= waiting - 1) {
      const auto leaf = row * kLanes + static_cast<std::size_t>(std::countr_zero(waiting));
      memory_.leaf_next_[leaf] = kNever;
      reader_.add(static_cast<std::uint32_t>(leaf));
    }
    double least[4] = {kNever, kNever, kNever, kNever};
    for (int i = 0; i < kLanes; ++i) least[i % 4] = std::min(least[i % 4], next[i]);
    const double earliest = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
    memory_.row_next_[row] = std::min(memory_.row_next_[row], earliest);
  }

  /// Bounds of the leaves of a row, or of the rows of a group.
  void boundChildren(std::size_t parent, SphereBounds& bounds) const noexcept {
    const auto& blocks = reading_.shell.blocks;
    if (parent < blocks.size()) {
      reading_.kernels.bound(reading_.field, reading_.motion, blocks[parent], static_cast<float>(cutoff_),
                             bounds);
      return;
    }
    // A shell of one leaf has no block above it.
    std::fill_n(bounds.free, kLanes, -1.0f);
  }

  /// Called after a read: computes how far the leaf may move. A saturated reading counts as a lower bound.
  void note(const ReadLeaf& leaf) noexcept {
    const double least = static_cast<double>(leaf.least()) * reading_.field.quantum;
    double free = (least - cutoff_) / reading_.field.slope;
    if (reading_.field.is_metric) free = std::max(free, least - error_ - beyond_);
    QueryMemory::Group& group = memory_.groups_[leaf.index / kGroupLeaves];
    double& leaf_next = memory_.leaf_next_[leaf.index];
    // A leaf may be read in several pieces: the first piece sets the threshold, the others lower it.
    const double until = group.odometer + std::max(0.0, free - kRounding);
    leaf_next = leaf.index == noted_ ? std::min(leaf_next, until) : until;
    noted_ = leaf.index;
    const std::size_t row = leaf.index / kLanes;
    const bool is_near = free * reading_.field.voxel_m < leaf.block.radius_m || leaf.block.count == 1;
    const auto bit = static_cast<std::uint16_t>(1U << leaf.index % kLanes);
    std::uint16_t& near = memory_.row_near_[row];
    near = static_cast<std::uint16_t>(is_near ? near | bit : near & ~bit);
    memory_.row_next_[row] = std::min(memory_.row_next_[row], leaf_next);
    group.next = std::min(group.next, leaf_next);
  }

  const MapReading& reading_;
  QueryMemory& memory_;
  const double cutoff_;
  const double error_;  ///< error of the field: half a cell's diagonal and a quantum
  const double beyond_;
  const Mat3 turn_;  // change of the pose since the last one
  const Vec3 shift_;
  const double turn_norm_;
  std::uint32_t noted_ = UINT32_MAX;
  LeafReader<Reader> reader_;
};

/// The memory if it belongs to this map and shell, otherwise null.
inline QueryMemory* memoryFor(QueryMemory* memory, const VoxMap& map, const PointShell& shell) noexcept {
  return memory != nullptr && memory->isFor(map, shell) ? memory : nullptr;
}

/// Calls consume(const ReadLeaf&), in ascending order, for every leaf that may have a point within the
/// cutoff; returns a lower bound of the readings at the points of all other leaves [voxels].
template <typename Consume>
double readNearLeaves(const MapReading& reading, const Pose& X_MP, const QueryOptions& options,
                      double cutoff_m, QueryMemory* memory, std::size_t& points_read,
                      Consume consume) noexcept {
  const double cutoff = cutoff_m / reading.field.voxel_m;
  double least = std::numeric_limits<double>::infinity();
  if (reading.shell.leaf_blocks == 0) return least;
  if (memory != nullptr && !options.is_exhaustive) {
    using Walk = CoherentWalk<Consume>;
    Walk::begin(*memory, reading, cutoff, X_MP);
    Walk walk(reading, X_MP, cutoff, *memory, consume);
    for (std::size_t g = 0; g < groupCount(reading.shell); ++g) walk.visit(g);
    walk.flush();
    Walk::end(*memory, X_MP);
    points_read = walk.pointsRead();
    return cutoff;
  }
  LeafReader<Consume> reader(reading, consume);
  if (options.is_exhaustive)
    least = readEverything(reading, reader);
  else
    least = walkNear(reading, static_cast<std::uint32_t>(reading.shell.blocks.size() - 1),
                     static_cast<float>(cutoff), [&](std::uint32_t leaf) { reader.add(leaf); });
  reader.flush();
  points_read = reader.pointsRead();
  return least;
}

/// Sets the result's distance from the least reading [quanta] and the lower bound for the points that were
/// not read [voxels].
inline void setDistance(const VoxMap& map, const MapReading& reading, float least_read, double least_skipped,
                        QueryResult& result) noexcept {
  const double read_m = reading.field.quantum_m * least_read;
  // If nothing was skipped, the bound stays infinite; min() is needed because saturated bounds were rounded
  // to floats.
  const double skipped_m = std::isfinite(least_skipped)
                               ? std::min(map.band_m(), reading.field.voxel_m * least_skipped)
                               : least_skipped;
  result.min_distance_m = std::min(read_m, skipped_m);
  result.is_beyond_band = skipped_m < read_m || !(read_m < map.band_m());
}

}  // namespace vps
