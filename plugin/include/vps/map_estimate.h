// SPDX-License-Identifier: BSD-3-Clause
// The memory of a voxmap, estimated before it is built.
#pragma once

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/voxmap.h"

namespace vps {

/// Estimates the bytes that building a mesh's map takes: the bricks that meet a slab of the surface's area,
/// as thick as the band, and the directory of its box. buildVoxMap() uses this estimate to refuse maps that
/// would not fit. It holds for surfaces of many bricks; a part smaller than a brick may take somewhat more.
/// O(triangles).
VPS_API double expectedMapBytes(const Mesh& mesh, const VoxMapSettings& settings);
/// The limit of this estimate above which buildVoxMap() refuses to build a map.
VPS_API double largestMapBytes();
/// The smallest voxel size, not below the settings' own, at which the estimate is at most `most_bytes`; to
/// 0.1 %. Infinite if no voxel size is large enough. O(triangles).
VPS_API double fittingVoxel_m(const Mesh& mesh, const VoxMapSettings& settings, double most_bytes);

}  // namespace vps
