// SPDX-License-Identifier: BSD-3-Clause
// Triangulates Open CASCADE shapes.
#pragma once

#include <vector>

#include <TopoDS_Shape.hxx>

#include "vps/mesh.h"
#include "vps_scenes/import.h"

namespace vps::scenes::inline v0::import {

/// The rigid pieces of a shape: each solid, and the faces outside of solids, sewn together where they meet.
std::vector<TopoDS_Shape> pieces(const TopoDS_Shape& shape);

/// Triangles of all faces, in the shape's length unit (a metre has units_per_m of them), outward for a solid.
/// Faces of one shape share the points of their common edges, so welding closes it.
Mesh meshOf(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m);

}  // namespace vps::scenes::inline v0::import
