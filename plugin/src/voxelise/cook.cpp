// SPDX-License-Identifier: BSD-3-Clause
// Cooks several parts into one voxmap, each voxelised at its own pose.
#include "voxmap/map_limits.h"
#include "voxmap/voxmap_access.h"
#include "vps/errors.h"
#include "vps/solid.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

VoxMap mapOf(const PlacedMesh& part, const VoxMapSettings& settings) {
  return buildVoxMap(transformed(*part.mesh, part.X_MP), settings);
}

VoxMap mapOf(const PlacedSolid& part, const VoxMapSettings& settings) {
  return buildVoxMap(part, settings);
}

template <typename Part>
VoxMap cooked(const std::vector<Part>& parts, const VoxMapSettings& settings, const Progress& progress) {
  if (parts.empty()) throw LoadError("", "", "no parts to cook into one voxmap; give at least one");
  VoxMap cooked;
  StoppableWork work(progress);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    work.report("cooking", static_cast<double>(i) / static_cast<double>(parts.size()));
    requirePose(parts[i].X_MP);
    const VoxMap map = mapOf(parts[i], settings);
    cooked = i == 0 ? map : mergedVoxMap(cooked, map);
  }
  work.report("cooking", 1);
  return parts.size() > 1 ? packedVoxMap(cooked) : cooked;
}

template <typename Part>
VoxMap mounted(const VoxMap& cooked, const Part& part) {
  requirePose(part.X_MP);
  const VoxMapSettings settings = {cooked.voxel_m(), cooked.band_m() / cooked.voxel_m()};
  return mergedVoxMap(cooked, mapOf(part, settings));
}

}  // namespace

VoxMap cookVoxMap(const std::vector<PlacedMesh>& parts, const VoxMapSettings& settings,
                  const Progress& progress) {
  return cooked(parts, settings, progress);
}

VoxMap cookVoxMap(const std::vector<PlacedSolid>& parts, const VoxMapSettings& settings,
                  const Progress& progress) {
  return cooked(parts, settings, progress);
}

VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMesh& part) {
  return mounted(cooked, part);
}

VoxMap mountVoxMap(const VoxMap& cooked, const PlacedSolid& part) {
  return mounted(cooked, part);
}

}  // namespace vps
