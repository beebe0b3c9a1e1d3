// SPDX-License-Identifier: BSD-3-Clause
// What closes an open mesh.
#pragma once

#include "vps/mesh.h"
#include "vps/pose.h"

namespace vps {

/// Lids for an open mesh: each group of connected open edges is joined to its centre, so that a flat hole is
/// closed exactly. An edge is open where its facets do not run along it both ways equally often. Empty for a
/// closed mesh. Expects shared vertices (see welded()), which the lids keep the numbers of. O(n log n).
VPS_API Mesh lidsOf(const Mesh& mesh);

}  // namespace vps
