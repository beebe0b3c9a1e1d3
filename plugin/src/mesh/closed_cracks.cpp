// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/closed_cracks.h"

#include <algorithm>
#include <numeric>

#include "mesh/joined_edges.h"

namespace vps {

namespace {

/// For each vertex the number of facets that have it as a corner.
std::vector<std::uint32_t> usesOf(const Mesh& mesh) {
  std::vector<std::uint32_t> uses(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) ++uses[v];
  return uses;
}

/// For each vertex the vertex with which it is joined; its own number if it is joined with none.
std::vector<std::uint32_t> groupsOf(const Mesh& mesh, const JoinedFacets& joined) {
  std::vector<std::uint32_t> group(mesh.vertices.size());
  std::iota(group.begin(), group.end(), 0U);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) group[mesh.triangles[i][k]] = joined.triangles[i][k];
  return group;
}

}  // namespace

ClosedCracks closeCracks(const Mesh& mesh, const std::vector<HalfEdge>& edges) {
  ClosedCracks closed{mesh};
  const double size_m = bounds(mesh).size().norm();
  const double widest = size_m > 0 ? std::min(kClosedCrackShare, kClosedCrack_m / size_m) : 0;
  const std::vector<std::uint32_t> group = groupsOf(mesh, joinFacets(mesh, edges, widest)),
                                   uses = usesOf(mesh);
  std::vector<std::uint32_t> place(mesh.vertices.size());  // by group: the vertex with the most facets
  std::iota(place.begin(), place.end(), 0U);
  for (std::uint32_t v = 0; v < group.size(); ++v)
    if (uses[v] > uses[place[group[v]]]) place[group[v]] = v;
  for (std::uint32_t v = 0; v < group.size(); ++v) {
    if (place[group[v]] == v || uses[v] == 0) continue;
    ++closed.corners;
    closed.widest_m = std::max(closed.widest_m, (mesh.vertices[v] - mesh.vertices[place[group[v]]]).norm());
  }
  if (closed.corners == 0) return closed;
  closed.mesh.triangles.clear();
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> moved = {place[group[t[0]]], place[group[t[1]]], place[group[t[2]]]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
      closed.mesh.triangles.push_back(moved);
  }
  return closed;
}

}  // namespace vps
