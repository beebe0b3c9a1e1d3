// SPDX-License-Identifier: BSD-3-Clause
// The number of points of a pointshell, estimated before it is built.
#pragma once

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// The smallest spacing, but not below the given one, at which buildPointShell() does not refuse the mesh for
/// its number of points. O(triangles).
VPS_API double fittingSpacing_m(const Mesh& mesh, double spacing_m);

}  // namespace vps
