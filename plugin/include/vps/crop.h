// SPDX-License-Identifier: BSD-3-Clause
// Models reduced to the boxes in which a scene uses them.
#pragma once

#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// A copy of the map that keeps only the nodes in and around the boxes; readings there are the same to the
/// bit. Elsewhere it reads as saturated, with the right sign for each cell, and its bounds do not hold: use
/// it only for queries whose points, and the centres of their clusters, stay in one of the boxes. More parts
/// can be mounted on it. O(cells).
VPS_API VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M);

/// A shell of the points in the boxes, in the same order and clusters: a query against a field that stays in
/// the boxes finds the same contacts to the bit, under smaller ids. O(points).
VPS_API PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P);

}  // namespace vps
