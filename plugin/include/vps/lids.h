// SPDX-License-Identifier: BSD-3-Clause
// Lids that close an open mesh.
#pragma once

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps {

/// Lids for an open mesh: each group of connected open edges is joined to its centre, so that a flat hole is
/// closed exactly. An edge is open if its facets do not run along it equally often in both directions. Empty
/// for a closed mesh. Expects shared vertices (see welded()); the lids use the mesh's vertex numbers.
/// O(n log n).
VPS_API Mesh lidsOf(const Mesh& mesh);

}  // namespace vps
