// SPDX-License-Identifier: BSD-3-Clause
// Finds vertices and facets at which pseudonormals give the right sign.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps {

class Interior;

/// A flag for each vertex: every edge at it has two triangles that agree on orientation, and its triangles
/// form one fan. At such a vertex pseudonormals distinguish the two sides of the surface. O(n log n).
std::vector<std::uint8_t> regularVertices(const Mesh& mesh);

/// For each triangle of `surface` a distance up to which the pseudonormal at a nearest point on the triangle
/// gives the same side as the winding number; 0 if no such distance is known. A distance is known if
/// - all vertices of the triangle are regular, and no triangle crosses it, so that the surface there has two
///   sides;
/// - the winding number is below 0.5 in front of the triangle and above 0.5 behind it;
/// - the winding number's slope is too small to carry it past 0.5 within that distance.
/// Two winding numbers for each triangle; parallel.
std::vector<float> sureDistances(const MeshDistance& surface, const Interior& interior);

}  // namespace vps
