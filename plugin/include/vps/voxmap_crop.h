// SPDX-License-Identifier: BSD-3-Clause
// A voxmap reduced to the boxes in which a scene uses it.
#pragma once

#include <vector>

#include "vps/export.h"
#include "vps/voxmap.h"

namespace vps {

/// A copy of the map that keeps only the nodes in and around the boxes; readings there are the same to the
/// bit. Elsewhere it reads as saturated, with the right sign for each cell, and its bounds do not hold: use
/// it only for queries whose points, and the centres of their clusters, stay in one of the boxes. More parts
/// can be mounted on it. O(cells).
VPS_API VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M);

}  // namespace vps
