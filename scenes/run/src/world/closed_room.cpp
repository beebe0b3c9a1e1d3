// SPDX-License-Identifier: BSD-3-Clause
#include "world/closed_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "vps/mesh_repair.h"

namespace vps::scenes {

namespace {

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

/// By vertex: a vertex that stands for all that facets connect to it.
std::vector<std::uint32_t> shellOfVertices(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const auto& t : mesh.triangles)
    for (const int k : {1, 2}) parent[rootOf(parent, t[k])] = rootOf(parent, t[0]);
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = rootOf(parent, v);
  return parent;
}

/// Signed, of the triangle seen from the origin (van Oosterom and Strackee 1983).
double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Shells with an edge that does not have exactly two facets.
std::vector<bool> openShells(const Mesh& mesh, const std::vector<std::uint32_t>& shell) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  std::vector<bool> is_open(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end - i != 2) is_open[shell[edges[i].first]] = true;
    i = end;
  }
  return is_open;
}

/// How often the surface of each shell turns around p: a shell that faces in by -1 around what it holds.
std::vector<double> turnsAround(const Vec3& p, const Mesh& mesh, const std::vector<std::uint32_t>& shell) {
  std::vector<double> turns(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    turns[shell[t[0]]] +=
        solidAngle(mesh.vertices[t[0]] - p, mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p) /
        (4 * std::numbers::pi);
  return turns;
}

}  // namespace

bool isInClosedRoom(const Mesh& part, const Mesh& other, const Pose& X_OP) {
  if (!isWithin(moved(bounds(part), X_OP), bounds(other))) return false;
  const Mesh solid = repairMesh(welded(other)).solid;
  const std::vector<std::uint32_t> shell = shellOfVertices(solid);
  if (std::all_of(shell.begin(), shell.end(), [&](std::uint32_t s) { return s == shell[0]; })) return false;
  const std::vector<bool> is_open = openShells(solid, shell);
  constexpr std::size_t kVertices = 32;
  const std::size_t stride = std::max<std::size_t>(1, part.vertices.size() / kVertices);
  for (std::size_t i = 0; i < part.vertices.size(); i += stride) {
    const std::vector<double> turns = turnsAround(X_OP * part.vertices[i], solid, shell);
    for (std::size_t v = 0; v < turns.size(); ++v)
      if (turns[v] < -0.9 && !is_open[v]) return true;
  }
  return false;
}

}  // namespace vps::scenes
