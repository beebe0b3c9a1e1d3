// SPDX-License-Identifier: BSD-3-Clause
// The number of points of a pointshell, estimated before it is built.
#pragma once

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// The smallest spacing, not below the given one, at which buildPointShell() accepts the number of points.
/// O(triangles).
VPS_API double fittingSpacing_m(const Mesh& mesh, double spacing_m);

}  // namespace vps
