// SPDX-License-Identifier: BSD-3-Clause
// From distances at nodes within the band to a sampled map: borders, signs beyond the band, inside and
// outside. Shared by the voxeliser and the reader of files.
#pragma once

#include <cfloat>
#include <vector>

#include "voxmap_layout.h"

namespace vps {

/// A brick's own 8^3 nodes, z fastest, before its neighbours' border is added.
inline constexpr int kOwnNodes = VoxMap::kBrick * VoxMap::kBrick * VoxMap::kBrick;
using OwnNodes = std::array<float, kOwnNodes>;
constexpr int ownIndex(int x, int y, int z) {
  return (x * VoxMap::kBrick + y) * VoxMap::kBrick + z;
}

/// Beyond the band, not signed yet.
inline constexpr float kFar = FLT_MAX;

/// Nodes computed so far: directory cells, ascending, and the own nodes of each. Must hold every cell that
/// has a node within the band, border included (so also the low neighbours of cells with such nodes on their
/// low faces).
struct NodeBlocks {
  std::vector<std::size_t> cells;
  std::vector<OwnNodes> nodes;
};

/// Gives the directory its bricks, in a pool of their own: one where a node is within the band, else outside
/// or inside. Distances are rounded to the band's quantum (voxmap_layout.h).
void assembleBricks(VoxLayout& layout, const NodeBlocks& blocks, double band_m);

}  // namespace vps
