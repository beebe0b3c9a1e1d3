// SPDX-License-Identifier: BSD-3-Clause
// Finds the edges that continue in others, and the facets that approximate a curved surface.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "mesh/mesh_edges.h"
#include "vps/contact_tolerances.h"
#include "vps/pose.h"

namespace vps {

/// An end of an edge.
struct EdgeEnd {
  std::uint32_t vertex, edge;
  int end;    ///< 0 or 1
  Vec3 away;  ///< unit, along the edge
};

/// Calls visit(a, b) for each vertex at which exactly two ends meet, with these ends. O(n log n); sorts the
/// ends.
template <typename Visit>
void forEachJoint(std::vector<EdgeEnd>& ends, Visit visit) {
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
    return std::tie(a.vertex, a.edge) < std::tie(b.vertex, b.edge);
  });
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t next = i + 1;
    while (next < ends.size() && ends[next].vertex == ends[i].vertex) ++next;
    if (next - i == 2) visit(ends[i], ends[i + 1]);
    i = next;
  }
}

/// Facets that meet at less than 8 degrees belong to one curved surface if one of them also has such a
/// neighbour on another side. If neither facet has another such neighbour, the edge is a lone kink between
/// two planes. Triangles in one plane count as one facet. O(n) after the edges are sorted.
/// @param edges    sortedHalfEdges()
/// @param normals  one for each triangle, unit; zero for triangles without area
/// @return for each triangle whether it approximates a curved surface
std::vector<std::uint8_t> findCurvedFacets(std::span<const HalfEdge> edges, std::span<const Vec3> normals);

/// True if two triangles that meet at an edge are parts of one surface: of a plane, or of a curved surface
/// from which the edge stands out by less than 0.5 * kSamePlace_m.
/// @param width_m  width of the narrower triangle across the edge
bool isSmoothEdge(const Vec3& normal0, const Vec3& normal1, bool is_one_curved, double width_m);

}  // namespace vps
