// SPDX-License-Identifier: BSD-3-Clause
// Open meshes: the width of their holes, and their surface prepared for contact from both sides.
#pragma once

#include "vps/mesh.h"

namespace vps {

/// True if a mesh has a hole wider than wider_than_m, and so is a surface that other parts touch from both
/// sides. The width is four times the area of the hole's lid (see lidsOf()) over the length of its border:
/// the diameter of a round hole. Cracks and T-junctions count as closed, as in repairMesh(), and a hole of
/// three edges of different facets counts as a missing facet. False also for a solid with free sheets beside
/// it, which repairMesh() recognises. Expects a mesh that requireUsable() accepts. O(n log n).
bool isOpenSurface(const Mesh& mesh, double wider_than_m);

/// The given surface: each facet once, narrow cracks closed, and facets turned to agree with their
/// neighbours. Vertices are shared only by facets that agree across edges of two facets, so that sheets that
/// meet along an edge, or that turn over like a Moebius strip, have separate normals there. O(n log n).
Mesh sheetSurface(const Mesh& mesh);

}  // namespace vps
