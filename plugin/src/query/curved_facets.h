// SPDX-License-Identifier: BSD-3-Clause
// Finds the facets of a mesh that approximate a curved surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh_edges.h"
#include "vps/contact_tolerances.h"
#include "vps/pose.h"

namespace vps {

/// Facets that meet at less than 8 degrees belong to one curved surface if one of them also has such a
/// neighbour on another side. If neither has, the edge is a lone kink between two planes. Triangles in one
/// plane count as one facet. O(n) after the edges are sorted.
/// @param edges    sortedHalfEdges()
/// @param normals  one for each triangle, unit; zero for triangles without area
/// @return for each triangle whether it approximates a curved surface
std::vector<std::uint8_t> findCurvedFacets(std::span<const HalfEdge> edges, std::span<const Vec3> normals);

/// True if two triangles that meet at an edge are parts of one surface: of a plane, or of a curved surface
/// from which the edge stands out by less than 0.5 * kSamePlace_m.
/// @param width_m  width of the narrower triangle across the edge
bool isSmoothEdge(const Vec3& normal0, const Vec3& normal1, bool is_one_curved, double width_m);

}  // namespace vps
