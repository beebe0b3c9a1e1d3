// SPDX-License-Identifier: BSD-3-Clause
// Access to the private data of a VoxMap, for code that builds, merges, reads or stores maps.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Takes maps apart and makes maps of layouts. The only friend of VoxMap.
class VPS_API VoxMapAccess {
 public:
  [[nodiscard]] static const std::shared_ptr<const VoxLayout>& layout(const VoxMap& map) noexcept {
    return map.layout_;
  }
  /// A layout as a map.
  /// @param band_m  the band that was asked for, or the band as nodes represent it; see bandHeld()
  /// @param bounds  box of the surface, in M
  static VoxMap make(std::shared_ptr<const VoxLayout> layout, double voxel_m, double band_m,
                     const Box& bounds);
  /// A map without cells on a grid, to which fields can be added.
  static VoxMap empty(const VoxMapSettings& settings);
};

}  // namespace vps
