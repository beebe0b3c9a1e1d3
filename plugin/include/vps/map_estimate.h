// SPDX-License-Identifier: BSD-3-Clause
// What a voxmap will take, before it is built.
#pragma once

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/voxmap.h"

namespace vps {

/// Bytes that building a mesh's map takes: the bricks that meet a slab of the surface's area, as thick as the
/// band, and the directory of its box. What buildVoxMap() refuses by, long before memory runs out. For a
/// surface of many bricks; a part smaller than a brick may take some more. O(triangles).
VPS_API double expectedMapBytes(const Mesh& mesh, const VoxMapSettings& settings);

}  // namespace vps
