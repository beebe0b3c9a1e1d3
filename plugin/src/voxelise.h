// SPDX-License-Identifier: BSD-3-Clause
// Building and merging of voxmaps.
#pragma once

#include "voxmap_layout.h"

namespace vps {

/// What may look into a VoxMap while it is being made.
class VoxMapBuilder {
 public:
  static VoxMap build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                      const Progress& progress, MeshReport* report);
  /// Union of two maps with the same voxel and band. The second's parts get the next owner numbers.
  static VoxMap merge(const VoxMap& a, const VoxMap& b);
  static VoxMap packed(const VoxMap& map);
};

}  // namespace vps
