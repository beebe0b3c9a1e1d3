// SPDX-License-Identifier: BSD-3-Clause
// The memory layout of a VoxMap.
//
//   directory: dense 3-D array of cells over the part's box, its band and one more empty cell on each side
//     cell --> brick: 9^3 nodes at spacing h, cells of 8h; the last layer repeats the next brick's first
//         `---> or one of two constant bricks: all +band (far outside) or all -band (far inside)
//
// Why 9^3 and not 8^3: each of a brick's 8^3 cells then finds its eight nodes in one brick, without a branch
// or a second look-up, for 1.42 times the memory. Why constant bricks: reading an empty cell then takes no
// branch either. Why 16 bits: they halve the memory traffic compared with 32, at an error of 6e-5 voxel for a
// band of 4.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "vps/voxmap.h"

namespace vps {

using Index3 = Eigen::Vector3i;

/// Number of nodes along an edge of a brick, border included, and in the whole brick.
inline constexpr int kBrick = VoxMap::kBrick;
inline constexpr int kNodes = kBrick + 1;
inline constexpr int kBrickNodes = kNodes * kNodes * kNodes;
/// Distance from one brick to the next in memory [nodes]: whole cache lines.
inline constexpr std::uint32_t kBrickStride = (kBrickNodes + 31) / 32 * 32;
static_assert(kBrickStride * sizeof(std::int16_t) % 64 == 0);

/// A node's distance in quanta; +-kFullBand means the end of the band or beyond.
using NodeValue = std::int16_t;
inline constexpr int kFullBand = 32767;

/// Index of a node in a brick's arrays, z fastest, and the inverse.
constexpr int nodeIndex(int x, int y, int z) {
  return (x * kNodes + y) * kNodes + z;
}
inline Index3 nodeAt(int index) {
  return {index / (kNodes * kNodes), index / kNodes % kNodes, index % kNodes};
}

/// Names of the two constant bricks in every pool.
inline constexpr std::uint32_t kOutside = 0, kInside = kBrickStride;
constexpr bool isConstant(std::uint32_t brick) {
  return brick <= kInside;
}

/// The most memory that a map may take. Assumed: a share of a workstation of 16 GiB that leaves room for
/// several parts.
inline constexpr double kMemoryLimit_bytes = 4.0 * 1024 * 1024 * 1024;

/// Size of a large page, where the system has them; nodes begin at a page.
inline constexpr std::size_t kPage = std::size_t{2} << 20;

/// The largest value of VoxLayout::far_cells: 40 voxels. Groups of 4096 neighbouring points of the
/// benchmarks' shells have a radius of 24 to 36 voxels.
inline constexpr int kMostFarCells = 5;

/// The owner of each node of a brick where parts meet.
using NodeOwners = std::array<std::uint16_t, kBrickNodes>;

/// A pool of bricks. A brick's name is the index of its first node. Memory is reserved once and filled from
/// the front. A brick does not change while a map uses it, so maps that were mounted on one another share a
/// pool, and mounting costs only the new part. Reserved memory that is not filled yet costs nothing on
/// systems that allocate pages at the first access.
class VPS_API VoxPool {
 public:
  /// Greatest number of bricks that can have a name, in addition to the two constant bricks.
  static constexpr std::size_t kMaxBricks = UINT32_MAX / kBrickStride - 2;

  /// Reserves memory for `capacity` bricks, for as many again for parts that are mounted later, and for the
  /// two constant bricks, which it creates.
  explicit VoxPool(std::size_t capacity);

  /// Allocates `count` consecutive bricks of owner 0 and returns the first one's name, or 0 if the pool is
  /// full. Thread-safe.
  [[nodiscard]] std::uint32_t take(std::size_t count) noexcept;
  /// Frees the bricks of a take(). Thread-safe.
  void giveBack(std::uint32_t first, std::size_t count) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return used_; }  ///< bricks, including the constant ones

  [[nodiscard]] NodeValue* nodes(std::uint32_t brick) noexcept { return nodes_.get() + brick; }
  [[nodiscard]] const NodeValue* nodes(std::uint32_t brick) const noexcept { return nodes_.get() + brick; }
  /// Owner of all nodes of a brick, unless mixed.
  [[nodiscard]] std::uint16_t& owner(std::uint32_t brick) noexcept { return owner_[brick / kBrickStride]; }
  [[nodiscard]] std::uint16_t owner(std::uint32_t brick) const noexcept {
    return owner_[brick / kBrickStride];
  }
  /// An owner for each node; null if the brick has one owner.
  [[nodiscard]] const NodeOwners*& mixed(std::uint32_t brick) noexcept {
    return mixed_[brick / kBrickStride];
  }
  [[nodiscard]] const NodeOwners* mixed(std::uint32_t brick) const noexcept {
    return mixed_[brick / kBrickStride];
  }
  [[nodiscard]] std::uint16_t ownerOf(std::uint32_t brick, int node) const noexcept {
    const NodeOwners* owners = mixed(brick);
    return owners != nullptr ? (*owners)[node] : owner(brick);
  }

  /// Bytes of a brick.
  static constexpr std::size_t kBytes =
      kBrickStride * sizeof(NodeValue) + sizeof(std::uint16_t) + sizeof(const NodeOwners*);

 private:
  struct Free {
    void operator()(NodeValue* p) const { ::operator delete (p, std::align_val_t{kPage}); }
  };
  std::size_t capacity_;  // including the constant bricks
  std::atomic<std::size_t> used_ = 0;
  std::mutex mutex_;                         // for take() and giveBack()
  std::map<std::size_t, std::size_t> free_;  // freed runs: first and count, in bricks; never adjacent
  std::unique_ptr<NodeValue[], Free> nodes_;
  std::unique_ptr<std::uint16_t[]> owner_;
  std::unique_ptr<const NodeOwners*[]> mixed_;
};

/// Frees bricks of a pool when no map uses them any more, so that the memory of an abandoned mounting serves
/// the next one.
class BrickLease {
 public:
  BrickLease(std::shared_ptr<VoxPool> pool, std::uint32_t first, std::size_t count)
      : pool_(std::move(pool)), first_(first), count_(count) {}
  ~BrickLease() { pool_->giveBack(first_, count_); }
  BrickLease(const BrickLease&) = delete;
  BrickLease& operator=(const BrickLease&) = delete;

 private:
  std::shared_ptr<VoxPool> pool_;
  std::uint32_t first_;
  std::size_t count_;
};

/// Data of a part in a map that mounting another part needs.
struct VoxPartRange {
  Box bounds;   ///< of the part's surface, in M [m]
  Index3 low;   ///< first cell of the part's own directory
  Index3 high;  ///< one past the last cell
};

/// A box of cells, z fastest.
struct CellBox {
  Index3 low = Index3::Zero();   ///< the first cell; cell c holds nodes 8c to 8c + 8
  Index3 size = Index3::Zero();  ///< cells along each axis

  [[nodiscard]] std::size_t cellCount() const noexcept {
    return static_cast<std::size_t>(size.cast<std::int64_t>().prod());
  }
  [[nodiscard]] std::size_t cellIndex(const Index3& cell) const noexcept {
    const Index3 i = cell - low;
    return (static_cast<std::size_t>(i.x()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(i.y())) *
               static_cast<std::size_t>(size.z()) +
           static_cast<std::size_t>(i.z());
  }
  [[nodiscard]] Index3 cellAt(std::size_t index) const noexcept {
    const auto ny = static_cast<std::size_t>(size.y()), nz = static_cast<std::size_t>(size.z());
    return low + Index3(static_cast<int>(index / (ny * nz)), static_cast<int>(index / nz % ny),
                        static_cast<int>(index % nz));
  }
  [[nodiscard]] bool holds(const Index3& cell) const noexcept {
    return (cell.array() >= low.array()).all() && (cell.array() < (low + size).array()).all();
  }
};

struct VoxLayout : CellBox {
  std::vector<std::uint32_t> bricks;  ///< by cell
  /// By cell, at its centre: a lower bound of the distance to the surface [m], with the sign of inside or
  /// outside.
  std::vector<float> centers_m;
  /// By cell: within how many cells in every direction all cells, including itself, are the outer constant
  /// brick; 0 if the cell or a neighbour is another brick, and at most kMostFarCells. markFarCells() computes
  /// it from `bricks`; if empty, queries are slower but otherwise the same.
  std::vector<std::uint8_t> far_cells;
  std::shared_ptr<VoxPool> pool;
  std::vector<std::shared_ptr<const std::vector<NodeOwners>>> owners;  ///< memory that mixed bricks point to
  std::vector<std::shared_ptr<const BrickLease>> leases;               ///< leases of mounted bricks
  std::vector<VoxPartRange> parts;
  /// The largest difference of neighbouring nodes, in voxels: 1 for true distances; more where signs change
  /// without a surface, and in level sets of other programs.
  float steepest = 1;
  /// The largest error of a node, in voxels, besides rounding: 0 after voxelising, half a cell's diagonal
  /// after resampling, and the measured error (field_bounds.h) in a level set of another program.
  float node_error = 0;
  /// False where signs contradict each other: nodes are then not distances, and only `steepest` bounds them.
  bool is_metric = true;
  void resizeCells() {
    bricks.assign(cellCount(), kOutside);
    centers_m.assign(bricks.size(), 0);
  }
  /// Bytes of a cell: its brick's name, its entry of centers_m, its entry of far_cells.
  static constexpr std::size_t kCellBytes = sizeof(std::uint32_t) + sizeof(float) + sizeof(std::uint8_t);
  /// The nodes of a cell's brick.
  [[nodiscard]] const NodeValue* nodesOf(std::size_t cell) const noexcept {
    return pool->nodes(bricks[cell]);
  }
};

/// Allocates consecutive bricks for a layout and returns the first one's name (VoxPool), 0 for none. If the
/// pool is full, the layout first moves to a larger pool, in which its bricks get new names. Not thread-safe
/// for one layout; other layouts of the same pool may be read and written meanwhile. Throws LoadError for
/// more bricks than names.
std::uint32_t takeBricks(VoxLayout& layout, std::size_t count);

/// Copies the bricks that a layout uses to a new pool with room for `room` more. Mounting leaves unused
/// bricks behind, and a shared pool also has bricks of other maps, which other threads may be writing. Throws
/// as takeBricks().
void moveToNewPool(VoxLayout& layout, std::size_t room);

/// Computes VoxLayout::far_cells from the final bricks. Cells beyond the directory count as outer constant.
VPS_API void markFarCells(VoxLayout& layout);

/// The quantum of nodes [m]. Rounded to float, so that its product with any node is exact in double, and the
/// full band is exactly VoxMap::band_m().
inline double quantumOf(double band_m) {
  return static_cast<float>(band_m / kFullBand);
}
/// The band as nodes represent it: the distance that a saturated node reads as.
inline double bandHeld(double band_m) {
  return kFullBand * quantumOf(band_m);
}
/// Rounds a distance in quanta, |quanta| <= kFullBand, to a node's value: to nearest, halves away from zero.
/// All nodes are rounded by this function; its plain arithmetic lets compilers vectorise loops over it.
template <typename Real>
inline NodeValue nodeOf(Real quanta) {
  return static_cast<NodeValue>(static_cast<int>(quanta + std::copysign(Real{0.5}, quanta)));
}

}  // namespace vps
