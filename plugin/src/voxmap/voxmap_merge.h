// SPDX-License-Identifier: BSD-3-Clause
// Merges another field into a map: another map on the same grid, or a map that is resampled during the merge.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// A field on a map's grid, brick by brick, in a box of cells. Reading it is thread-safe.
class AddedField : public CellBox {
 public:
  virtual ~AddedField() = default;
  /// Writes all kBrickStride nodes of a cell that is not constant.
  virtual void write(std::size_t cell, NodeValue* nodes) const = 0;
  [[nodiscard]] virtual std::uint16_t ownerOf(std::size_t cell, int node) const = 0;
  [[nodiscard]] virtual bool hasMixedOwners(std::size_t cell) const = 0;

  std::vector<std::uint32_t> kinds;  ///< by cell: kOutside, kInside, or another value if it has nodes
  std::vector<float> centers_m;      ///< as in VoxLayout
  std::vector<VoxPartRange> parts;
  float steepest = 1, node_error = 0;  ///< as in VoxLayout
  bool is_metric = true;
};

/// The union of a map and a field on its grid; the field's parts get the next owner numbers.
VoxMap mergedVoxMap(const VoxMap& a, const AddedField& b, const Box& bounds_of_b);
/// As above, for two maps with equal voxel and band.
VoxMap mergedVoxMap(const VoxMap& a, const VoxMap& b);

/// The map with its bricks in a pool of its own, without the bricks that merging leaves unused.
VoxMap packedVoxMap(const VoxMap& map);

}  // namespace vps
