// SPDX-License-Identifier: BSD-3-Clause
// Finds the leaves of a shell that may matter at a pose, and reads them in batches in ascending order.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxmap/kernels/read_kernel.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// A map, a shell and a pose, prepared for reading.
struct MapReading {
  MapReading(const VoxMap& map, const PointShell& its_shell, const Pose& X_MP, Simd simd) noexcept
      : field(map), motion(field, X_MP), shell(its_shell), kernels(readKernels(simd)) {
    field.prefetches = shell.leaf_blocks > kCachedLeaves;
  }

  /// Number of leaves whose nodes stay in the L2 cache from query to query. Assumed: about 20 lines of 64
  /// bytes for each leaf, in 1 MB. Prefetching nodes that are in the cache costs a tenth of a read.
  static constexpr std::size_t kCachedLeaves = 512;

  FieldView field;
  GridPose motion;
  const PointShell& shell;
  const ReadKernels& kernels;
};

/// A leaf that has been read: its block, and its slot in the batch.
struct ReadLeaf {
  const ShellBlock& block;
  std::uint32_t index;  ///< index of the leaf among the shell's blocks
  const ReadBatch& batch;
  int slot;

  [[nodiscard]] float least() const { return batch.least[slot]; }
  [[nodiscard]] float value(int lane) const { return batch.value[kLanes * slot + lane]; }
};

/// True if every point under a block lies where all cells are the outer constant, so that the field's value
/// at the point is the band's width.
inline bool isFarOutside(const MapReading& reading, const ShellBlock& block) noexcept {
  const FieldView& f = reading.field;
  const double reach = block.radius_m / f.voxel_m + 1;  // as in read()
  bool is_within = true;
  std::int64_t cell = 0;
  for (int k = 0; k < 3; ++k) {
    const double* R = reading.motion.R + 3 * k;
    const double at =
        reading.motion.p[k] + R[0] * block.center[0] + R[1] * block.center[1] + R[2] * block.center[2];
    const double end = VoxMap::kBrick * f.size[k];
    if (at < -reach || at > end + reach) return true;
    is_within = is_within && at >= 0 && at < end;
    cell = cell * f.size[k] + (is_within ? static_cast<std::int64_t>(at) / VoxMap::kBrick : 0);
  }
  return is_within && f.far_cells != nullptr && reach <= VoxMap::kBrick * f.far_cells[cell];
}

/// Collects leaves until a batch is full, reads them, and hands each to `consume(const ReadLeaf&)`.
template <typename Consume>
class LeafReader {
 public:
  LeafReader(const MapReading& reading, Consume consume) noexcept : reading_(reading), consume_(consume) {}

  void add(std::uint32_t leaf) noexcept {
    const ShellBlock& block = reading_.shell.blocks[leaf];
    if (block.radius_m > kFineEnough * reading_.field.voxel_m) {
      flush();
      readOneByOne(block, leaf);
      return;
    }
    blocks_[count_] = &block;
    leaves_[count_++] = leaf;
    if (count_ == kBatch) flush();
  }

  void flush() noexcept {
    if (count_ == 0) return;
    reading_.kernels.read(reading_.field, reading_.motion, blocks_, count_, batch_);
    points_ += countPoints();
    for (int i = 0; i < count_; ++i) consume_(ReadLeaf{*blocks_[i], leaves_[i], batch_, i});
    count_ = 0;
  }

  /// Counts the points of leaves whose reading is known without a read.
  void countKnown(std::size_t points) noexcept { points_ += points; }
  [[nodiscard]] std::size_t pointsRead() const noexcept { return points_; }

 private:
  /// Largest radius of a leaf, in voxels, at which the rounding error of floats stays within a step, 6e-5
  /// voxel.
  static constexpr double kFineEnough = 100;

  [[nodiscard]] std::size_t countPoints() const noexcept {
    std::size_t points = 0;
    for (int i = 0; i < count_; ++i) points += blocks_[i]->count;
    return points;
  }

  /// Reads the points of a leaf that is much larger than a voxel as blocks of one point.
  void readOneByOne(const ShellBlock& block, std::uint32_t leaf) noexcept {
    ShellBlock singles[kLanes];
    for (std::uint32_t i = 0; i < block.count; ++i) {
      const Vec3& p = reading_.shell.points[block.first + i];
      for (int k = 0; k < 3; ++k) singles[i].center[k] = p[k];
      singles[i].first = block.first + i;
      singles[i].count = singles[i].is_leaf = 1;
      singles[i].weight[0] = block.weight[i];
      blocks_[count_] = &singles[i];
      leaves_[count_++] = leaf;
    }
    flush();
  }

  const MapReading& reading_;
  Consume consume_;
  ReadBatch batch_;
  const ShellBlock* blocks_[kBatch];
  std::uint32_t leaves_[kBatch];
  int count_ = 0;
  std::size_t points_ = 0;
};

/// Leaves per group: 4096 points, all under one block of the second level.
inline constexpr std::size_t kGroupLeaves = kLanes * kLanes;
inline constexpr std::size_t kGroupRows = kGroupLeaves / kLanes;  ///< rows of sixteen leaves
inline std::size_t rowCount(const PointShell& shell) noexcept {
  return (shell.leaf_blocks + kLanes - 1) / kLanes;
}
inline std::size_t groupCount(const PointShell& shell) noexcept {
  return (shell.leaf_blocks + kGroupLeaves - 1) / kGroupLeaves;
}

/// Hands every leaf to a reader, except groups and rows where all cells are the outer constant. Returns a
/// lower bound of the readings of the leaves that were left out [voxels]; it is above the band, which is
/// their reading.
template <typename Reader>
double readEverything(const MapReading& reading, Reader& reader) noexcept {
  const auto& blocks = reading.shell.blocks;
  const std::size_t leaves = reading.shell.leaf_blocks, rows = rowCount(reading.shell);
  double least = std::numeric_limits<double>::infinity();
  // True if the leaves from `first` on need no reading; `parent` is the block above them, if there is one.
  const auto isKnown = [&](std::size_t parent, std::size_t first, std::size_t count) {
    if (parent >= blocks.size() || !isFarOutside(reading, blocks[parent])) return false;
    const ShellBlock& last = blocks[std::min(first + count, leaves) - 1];
    reader.countKnown(last.first + last.count - blocks[first].first);
    least = 2 * static_cast<double>(reading.field.band);
    return true;
  };
  for (std::size_t g = 0; g < groupCount(reading.shell); ++g) {
    if (isKnown(leaves + rows + g, g * kGroupLeaves, kGroupLeaves)) continue;
    for (std::size_t row = g * kGroupRows; row < std::min(rows, (g + 1) * kGroupRows); ++row) {
      if (isKnown(leaves + row, row * kLanes, kLanes)) continue;
      for (std::size_t leaf = row * kLanes; leaf < std::min(leaves, (row + 1) * kLanes); ++leaf)
        reader.add(static_cast<std::uint32_t>(leaf));
    }
  }
  return least;
}

/// Walks the spheres under a block and calls `take(leaf)` for the leaves in which the field may reach the
/// cutoff [voxels]; returns the least bound of the other leaves [voxels].
template <typename Take>
float walkNear(const MapReading& reading, std::uint32_t root, float cutoff, Take take) noexcept {
  const auto& blocks = reading.shell.blocks;
  float least_skipped = std::numeric_limits<float>::infinity();
  // On each level sixteen children wait; 2^32 points make eight levels.
  std::uint32_t waiting[8 * kLanes];
  int count = 0;
  waiting[count++] = root;
  while (count > 0) {
    const std::uint32_t index = waiting[--count];
    const ShellBlock& block = blocks[index];
    if (block.is_leaf) {
      take(index);
      continue;
    }
    SphereBounds bounds;
    reading.kernels.bound(reading.field, reading.motion, block, cutoff, bounds);
    // Backwards, so that the first child is on top and leaves come in ascending order.
    for (std::uint32_t i = block.count; i-- > 0;) {
      if (bounds.least[i] > cutoff)
        least_skipped = std::min(least_skipped, bounds.least[i]);
      else
        waiting[count++] = block.first + i;
    }
  }
  return least_skipped;
}

}  // namespace vps
