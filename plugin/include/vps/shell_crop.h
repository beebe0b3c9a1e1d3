// SPDX-License-Identifier: BSD-3-Clause
// A pointshell reduced to the boxes in which a scene uses it.
#pragma once

#include <vector>

#include "vps/export.h"
#include "vps/pointshell.h"

namespace vps {

/// A shell of the points in the boxes, in the same order and clusters: a query against a field that stays in
/// the boxes finds the same contacts to the bit, under smaller ids. O(points).
VPS_API PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P);

}  // namespace vps
