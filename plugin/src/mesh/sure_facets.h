// SPDX-License-Identifier: BSD-3-Clause
// Where pseudonormals can be relied on.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps {

class Interior;

/// A flag for each vertex: every edge there has two triangles that agree on orientation, and the triangles
/// form one fan. There pseudonormals tell the two sides of the surface apart. O(n log n).
std::vector<std::uint8_t> regularVertices(const Mesh& mesh);

/// For each triangle of `surface` a distance up to which the pseudonormal at a nearest point on it gives the
/// same side as the winding number; 0 where that is not known. It is known where
/// - all its vertices are regular, and no triangle crosses it, so that the surface near it has two sides;
/// - the winding number is below 0.5 in front of it and above behind it;
/// - the winding number's slope cannot carry it past 0.5 from there to any point of that distance.
/// Two winding numbers a triangle; parallel.
std::vector<float> sureDistances(const MeshDistance& surface, const Interior& interior);

}  // namespace vps
