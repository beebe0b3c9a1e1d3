// SPDX-License-Identifier: BSD-3-Clause
// Meshes that are open: how wide their holes are, and the surface that is drawn, for contact from both sides.
#pragma once

#include "vps/mesh.h"

namespace vps {

/// True if a mesh has a hole wider than that, and so is a surface that is met from both sides. The width is
/// four times the area of the hole's lid (see lidsOf()) over the length of its border: the diameter of a
/// round hole. What cracks and T-junctions part counts as joined, as in repairMesh(), and a hole of three
/// edges of different facets as a facet that is missing. False also for a solid with free sheets beside it,
/// which repairMesh() tells apart. Expects a mesh that requireUsable() accepts. O(n log n).
bool isOpenSurface(const Mesh& mesh, double wider_than_m);

/// The drawn surface: each facet once, narrow cracks closed, and facets turned to agree with their
/// neighbours. Vertices are shared only by facets that agree across edges of two facets, so that sheets that
/// meet along an edge, or that turn over like a Moebius strip, have normals of their own there. O(n log n).
Mesh sheetSurface(const Mesh& mesh);

}  // namespace vps
