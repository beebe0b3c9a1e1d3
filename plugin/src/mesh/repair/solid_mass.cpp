// SPDX-License-Identifier: BSD-3-Clause
// Mass of a repaired mesh, with lids over its holes.
#include "vps/mesh_repair.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "mesh/mesh_edges.h"

namespace vps {

namespace {

struct OpenEdge {
  std::uint32_t low, high;
  int surplus;  ///< number of facets that run from low to high, minus those that run from high to low
};

std::vector<OpenEdge> openEdges(const Mesh& mesh) {
  std::vector<OpenEdge> open;
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    if (const int surplus = surplusOf(sides); surplus != 0)
      open.push_back({sides[0].low, sides[0].high, surplus});
  });
  return open;
}

}  // namespace

Mesh lidsOf(const Mesh& mesh) {
  const std::vector<OpenEdge> open = openEdges(mesh);
  Mesh lids;
  if (open.empty()) return lids;
  Groups groups(mesh.vertices.size());
  for (const OpenEdge& edge : open) groups.join(edge.low, edge.high);
  std::map<std::uint32_t, std::pair<Vec3, double>> center;  // by group: sum of length times place; length
  for (const OpenEdge& edge : open) {
    const Vec3 &a = mesh.vertices[edge.low], &b = mesh.vertices[edge.high];
    auto& [sum, length_m] = center.try_emplace(groups.find(edge.low), Vec3::Zero(), 0.0).first->second;
    sum += 0.5 * (b - a).norm() * (a + b);
    length_m += (b - a).norm();
  }
  lids.vertices = mesh.vertices;
  std::map<std::uint32_t, std::uint32_t> apex;
  for (const auto& [group, mean] : center) {
    apex[group] = static_cast<std::uint32_t>(lids.vertices.size());
    lids.vertices.push_back(mean.first / mean.second);
  }
  for (const OpenEdge& edge : open) {
    const auto [from, to] =
        edge.surplus > 0 ? std::pair(edge.high, edge.low) : std::pair(edge.low, edge.high);
    for (int i = 0; i < std::abs(edge.surplus); ++i)
      lids.triangles.push_back({from, to, apex[groups.find(edge.low)]});
  }
  return lids;
}

MassProperties massOf(const RepairedMesh& repaired) {
  constexpr double kFlat = 1e-12;  // share of the area times the size: rounding error
  const auto isClosed = [](const Mesh& mesh) { return lidsOf(mesh).triangles.empty(); };
  Mesh solid;
  const bool is_closed =
      repaired.is_sound || (repaired.report.sheet_facets == 0 && isClosed(repaired.surface));
  if (!is_closed) {
    solid = repaired.solid;
    append(solid, lidsOf(solid));
  }
  const Mesh& mesh = is_closed ? repaired.surface : solid;
  const MassProperties mass = massProperties(mesh);
  const bool is_flat = std::abs(mass.volume_m3) <= kFlat * area(mesh) * bounds(mesh).size().norm();
  return is_flat ? MassProperties{} : mass;
}

}  // namespace vps
