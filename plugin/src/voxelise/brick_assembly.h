// SPDX-License-Identifier: BSD-3-Clause
// From distances at nodes within the band to a sampled map: borders, signs beyond the band, inside and
// outside.
#pragma once

#include <cfloat>
#include <vector>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Beyond the band, not signed yet.
inline constexpr float kFar = FLT_MAX;

/// All nodes of a brick, border included.
using BrickNodes = std::array<float, kBrickNodes>;

/// Gives far nodes of a brick the band's distance, with the sign of a node beside them: where one of two
/// neighbours is far, the surface does not pass between, since the band is wider than a voxel. At least one
/// node must be known.
void saturate(BrickNodes& distance, float band);

/// Takes bricks that are whole, a batch at a time; the order of batches is the order of the bricks. Distances
/// may be in any unit: `per_unit` quanta.
class BrickWriter {
 public:
  /// @param expected  bricks to make room for at first; more cost a copy
  BrickWriter(VoxLayout& layout, double per_unit, std::size_t expected);

  /// Makes room for a batch; as takeBricks(), so that the bricks of batches before must be in the layout.
  void take(std::size_t count);
  /// Stores a brick in place `slot` of the last batch, saturated; its name. Thread-safe for different slots.
  /// Known nodes must be within the band.
  std::uint32_t write(std::size_t slot, BrickNodes& distance);

 private:
  VoxLayout& layout_;
  const double per_unit_;
  std::uint32_t first_ = 0;  // of the last batch
};

/// Empty cells, after all bricks are in: outside or inside.
void fillEmptyCells(VoxLayout& layout);

}  // namespace vps
