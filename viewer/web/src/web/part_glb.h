// SPDX-License-Identifier: BSD-3-Clause
// A part as binary glTF, for browsers.
#pragma once

#include <cstddef>
#include <string>

#include "mesh/shading_mesh.h"

namespace vps::viewer {

/// The bytes of a .glb file: one node with the surface (positions, normals, triangles) and, as lines, the
/// sharp edges; in metres and in the part's frame. The node's translation is the mesh's center, so that
/// floats keep their precision far out.
/// @param wanted     about as many triangles; a surface with no more stays as it is
/// @param has_edges  false: without the edges, from which a coarse surface is off
/// O(triangles). Source: Khronos, "glTF 2.0 Specification".
std::string partGlb(const ShadingMesh& mesh, std::size_t wanted, bool has_edges = true);

}  // namespace vps::viewer
