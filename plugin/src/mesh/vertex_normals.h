// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// For each vertex the sum of the normals of its facets, each times the facet's angle there: a normal that
/// does not depend on how faces are cut into facets. Not of unit length; zero at the edge of a blade, where
/// the facets' normals cancel. Source: Thuermer and Wuethrich 1998. O(triangles).
/// @param facet_normals  unit, or zero for a facet without a normal
std::vector<Vec3> angleWeightedNormals(const Mesh& mesh, std::span<const Vec3> facet_normals);

}  // namespace vps
