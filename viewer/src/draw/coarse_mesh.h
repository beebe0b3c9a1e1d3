// SPDX-License-Identifier: BSD-3-Clause
// A coarser version of a mesh, for drafts: pictures of a view that moves.
#pragma once

#include "draw/shading_mesh.h"

namespace vps::viewer::inline v0 {

/// Indices of about `wanted` triangles between some of the mesh's own vertices, or of all where it has no
/// more. The vertices within a cell of a cubic grid whose normals face the same side become one of them, and
/// triangles that collapse are dropped; a surface stays within a cell's diagonal of where it was.
/// O(triangles). Source: vertex clustering, Rossignac and Borrel 1993.
std::vector<std::uint32_t> coarseIndices(const ShadingMesh& mesh, std::size_t wanted);

}  // namespace vps::viewer::inline v0
