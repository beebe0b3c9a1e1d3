// SPDX-License-Identifier: BSD-3-Clause
// Finds facets that are crossed by other facets of their mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh_distance.h"

namespace vps {

/// Unknown: too many other facets are near.
enum class Crossed : std::uint8_t { No, Yes, Unknown };

/// For each of the first `count` triangles of a mesh: whether another triangle crosses it, or touches it
/// elsewhere than at a common vertex. Triangles that share an edge count only if one lies on the other;
/// copies of a triangle do not count as crossing. Expects shared vertices. Parallel; O(n log n) for usual
/// meshes.
std::vector<Crossed> crossedFacets(const MeshDistance& all, std::size_t count);

}  // namespace vps
