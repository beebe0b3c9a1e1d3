// SPDX-License-Identifier: BSD-3-Clause
// Finds facets that other facets of their mesh pass through.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh_distance.h"

namespace vps {

/// Unknown: too many others are near.
enum class Crossed : std::uint8_t { No, Yes, Unknown };

/// For each of the first `count` triangles of a mesh: whether another triangle crosses it, or touches it
/// elsewhere than at a common vertex. Triangles that share an edge count only if one lies on the other.
/// Expects shared vertices; a triangle that is there twice does not count as crossing itself. Parallel; O(n
/// log n) for usual meshes.
std::vector<Crossed> crossedFacets(const MeshDistance& all, std::size_t count);

}  // namespace vps
