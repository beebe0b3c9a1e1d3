// SPDX-License-Identifier: BSD-3-Clause
// Pointshells and voxels as meshes that can be drawn, as in figures 7 and 8 of the paper.
#pragma once

#include <array>
#include <vector>

#include "vps/pointshell.h"
#include "vps/voxmap.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Such a mesh has at most this many triangles, so that single points and cubes are seen in a picture.
inline constexpr std::size_t kModelTriangles = 120000;

/// A flat square diamond on each point, across its normal; of a shell with too many points, the even coarser
/// sampling that its order begins with.
/// @param size_m  of a diamond's diagonal; 0: 0.6 of the spacing of what is drawn
VPS_VIEWER_API Mesh pointMesh(const PointShell& shell, double size_m = 0);

/// A mesh with a tint for each vertex, as DrawnMesh::vertex_colors takes it.
struct TintedMesh {
  Mesh mesh;
  std::vector<std::array<float, 3>> tints;
};

/// Cubes of the grid whose middle is inside: their faces to the outside, by turns lighter and darker. A map
/// with too many of them is drawn with cubes of twice, thrice, ... the voxel's size.
/// @param cube_m  if given, receives their edge
VPS_VIEWER_API TintedMesh voxelMesh(const VoxMap& map, double* cube_m = nullptr);

}  // namespace vps::viewer
