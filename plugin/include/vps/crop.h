// SPDX-License-Identifier: BSD-3-Clause
// Models of a part's neighbourhood alone: what a scene that stays within some boxes needs of them.
#pragma once

#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// The map with its nodes in and around the boxes only, in memory of its own; to the bit the same there.
/// Elsewhere it reads as saturated, with the right sign by cells, and none of its bounds holds: only for
/// queries whose points, and the centres of their clusters, stay in one of the boxes. May be mounted upon.
/// O(cells).
VPS_API VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M);

/// The shell's points in the boxes only, in their order and in their clusters: a query of fields that stay in
/// the boxes finds the same contacts, to the bit, under smaller ids. O(points).
VPS_API PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P);

}  // namespace vps
