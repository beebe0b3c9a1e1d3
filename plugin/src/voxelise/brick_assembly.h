// SPDX-License-Identifier: BSD-3-Clause
// Completes bricks whose nodes within the band are known: borders, signs beyond the band, and empty cells.
#pragma once

#include <cfloat>
#include <vector>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Marks nodes beyond the band that have no sign yet.
inline constexpr float kFar = FLT_MAX;

/// All nodes of a brick, border included.
using BrickNodes = std::array<float, kBrickNodes>;

/// Sets far nodes of a brick to the band's distance with the sign of a neighbour node. This is right because
/// the band is wider than a voxel: if one of two neighbours is far, the surface does not pass between them.
/// At least one node must be known.
void saturate(BrickNodes& distance, float band);

/// Writes complete bricks into a layout, a batch at a time, in the order of the batches. The unit of the
/// distances is `per_unit` quanta.
class BrickWriter {
 public:
  /// @param expected  number of bricks for which memory is reserved; more bricks cost a copy
  BrickWriter(VoxLayout& layout, double per_unit, std::size_t expected);

  /// Allocates a batch as takeBricks(); the bricks of earlier batches must already be in the layout.
  void take(std::size_t count);
  /// Stores a brick, saturated, in `slot` of the last batch and returns its name. Thread-safe for different
  /// slots. Known nodes must be within the band.
  std::uint32_t write(std::size_t slot, BrickNodes& distance);

 private:
  VoxLayout& layout_;
  const double per_unit_;
  std::uint32_t first_ = 0;  // of the last batch
};

/// Decides whether empty cells are outside or inside, after all bricks are stored.
void fillEmptyCells(VoxLayout& layout);

}  // namespace vps
