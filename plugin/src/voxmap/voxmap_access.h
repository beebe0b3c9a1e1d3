// SPDX-License-Identifier: BSD-3-Clause
// Access to the private data of a VoxMap, for code that builds, reads or stores maps; and merging of a field
// into a map: of another map on the same grid, or of a map that is resampled during the merge.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Takes maps apart and makes maps of layouts. The only friend of VoxMap.
class VPS_API VoxMapAccess {
 public:
  [[nodiscard]] static const std::shared_ptr<const VoxLayout>& layout(const VoxMap& map) noexcept {
    return map.layout_;
  }
  /// Makes a map of a layout.
  /// @param band_m  the band that was asked for, or the band as nodes represent it; see bandHeld()
  /// @param bounds  box of the surface, in M
  static VoxMap make(std::shared_ptr<const VoxLayout> layout, double voxel_m, double band_m,
                     const Box& bounds);
  /// A map without cells on a grid, to which fields can be added.
  static VoxMap empty(const VoxMapSettings& settings);
};

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
/// The union of two maps with equal voxel and band.
VoxMap mergedVoxMap(const VoxMap& a, const VoxMap& b);

/// The map with its bricks in a pool of its own, without the bricks that merging leaves unused.
VoxMap packedVoxMap(const VoxMap& map);

}  // namespace vps
