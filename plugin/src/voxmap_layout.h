// SPDX-License-Identifier: BSD-3-Clause
// How a VoxMap lies in memory, and how it is sampled. In a header so that queries inline the sampling.
//
//   directory: dense 3-D array of cells over the part's box, its band and one empty cell more on each side
//     cell --> brick: 9^3 nodes at spacing h, cells of 8h; the last layer of nodes repeats the next brick's
//     first
//         `---> or one of two constant bricks: all +band (far outside) or all -band (far inside)
//
// Why 9^3 and not 8^3: any of a brick's 8^3 cells then finds its eight nodes in one brick, without a branch
// or a second look-up, for 1.42 times the memory. Why the constant bricks: reading a missing brick takes no
// branch either.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "vps/voxmap.h"

namespace vps {

using Index3 = Eigen::Vector3i;

/// Nodes of one brick along an edge, border included, and in all.
inline constexpr int kNodes = VoxMap::kBrick + 1;
inline constexpr int kBrickNodes = kNodes * kNodes * kNodes;

/// Position of a node in a brick's arrays; z runs fastest.
constexpr int nodeIndex(int x, int y, int z) {
  return (x * kNodes + y) * kNodes + z;
}

struct alignas(64) VoxBrick {
  std::array<float, kBrickNodes> distance_m;
  std::uint16_t owner = 0;                ///< of all nodes, unless `owners`
  const std::uint16_t* owners = nullptr;  ///< one a node, where parts meet
};

/// Bricks that came into being together. A map shares the pools of the map it was mounted on, so that
/// mounting costs what the new part costs.
struct VoxPool {
  std::vector<VoxBrick> bricks;
  std::vector<std::array<std::uint16_t, kBrickNodes>> owners;
};

/// One entry of the directory.
struct VoxCell {
  const VoxBrick* brick = nullptr;
  /// At the cell's centre: the sign, and a value [m] that the distance to the surface is not below.
  float center_m = 0;
};

/// What mounting must know of the parts already there.
struct VoxPartRange {
  Box bounds;   ///< of the part's surface, in M [m]
  Index3 low;   ///< first cell of the part's own directory
  Index3 high;  ///< one past the last
};

struct VoxLayout {
  Index3 low = Index3::Zero();   ///< the first cell; cell c holds nodes 8c to 8c + 8
  Index3 size = Index3::Zero();  ///< cells along each axis
  std::vector<VoxCell> cells;
  std::shared_ptr<const VoxPool> constants;  ///< two bricks: all +band, all -band
  std::vector<std::shared_ptr<const VoxPool>> pools;
  std::vector<VoxPartRange> parts;

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
  [[nodiscard]] const VoxBrick* outside() const noexcept { return &constants->bricks[0]; }
  [[nodiscard]] const VoxBrick* inside() const noexcept { return &constants->bricks[1]; }
  [[nodiscard]] bool isConstant(const VoxBrick* brick) const noexcept {
    return brick == outside() || brick == inside();
  }
};

}  // namespace vps
