// SPDX-License-Identifier: BSD-3-Clause
// Building and merging of voxmaps.
#pragma once

#include "voxmap/voxmap_layout.h"

namespace vps {

class AddedField;
struct CoarseRest;
struct RepairedMesh;
enum class Combine;

/// What may look into a VoxMap while it is being made.
class VoxMapBuilder {
 public:
  static VoxMap build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part,
                      const Progress& progress, MeshReport* report);
  static VoxMap buildInRegions(const Mesh& mesh, const VoxMapSettings& settings, const FineRegions& regions,
                               const std::string& part, const Progress& progress, MeshReport* report);
  /// Two fields with the same voxel and band. The second's parts get the next owner numbers.
  static VoxMap combined(const VoxMap& a, const AddedField& b, const Box& bounds_of_b, Combine combine);
  static VoxMap combined(const VoxMap& a, const VoxMap& b, Combine combine);
  static VoxMap packed(const VoxMap& map);
  static VoxMap cropped(const VoxMap& map, const std::vector<Box>& boxes_M);
  /// A layout as a map, whose box of the surface is known; the band as it was asked for or as nodes hold it.
  static VoxMap wrap(std::shared_ptr<const VoxLayout> layout, double voxel_m, double band_m,
                     const Box& bounds);
  /// The cells and bricks of a map.
  static const VoxLayout& layoutOf(const VoxMap& map);
  /// An empty map on a grid, to which fields are added.
  static VoxMap empty(const VoxMapSettings& settings);
  /// Throws LoadError for a map that is fine in regions only, which `what` cannot do with.
  static void requireOneGrid(const VoxMap& map, const char* what);

 private:
  /// @param mesh      what was given
  /// @param repaired  what repairMesh() made of it; made anew if its signs contradict each other
  static VoxMap build(const Mesh& mesh, RepairedMesh& repaired, const VoxMapSettings& settings,
                      const Progress& progress, MeshReport* report, const CoarseRest* regions);
};

}  // namespace vps
