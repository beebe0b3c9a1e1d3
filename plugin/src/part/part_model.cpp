// SPDX-License-Identifier: BSD-3-Clause
#include "vps/part_model.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "mesh/mesh_edges.h"
#include "mesh/repair/mesh_faults.h"
#include "mesh/solid/interior.h"
#include "vps/mesh_repair.h"

namespace vps {

namespace {

/// Shares vertices, closes narrow cracks, and keeps each facet once, in any orientation.
Mesh joinedOnce(const Mesh& mesh) {
  Mesh once = welded(mesh);
  once = closeCracks(once, sortedHalfEdges(once)).mesh;
  std::vector<std::uint8_t> is_dropped(once.triangles.size(), 0);
  forEachTwin(once.triangles, [&](std::span<const Twin> same) {
    for (const Twin& t : same.subspan(1)) is_dropped[t.triangle] = 1;
  });
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t i = 0; i < is_dropped.size(); ++i)
    if (is_dropped[i] == 0 && !hasRepeatedCorner(once.triangles[i])) kept.push_back(once.triangles[i]);
  once.triangles = std::move(kept);
  return once;
}

struct Hole {
  Vec3 center = Vec3::Zero();  ///< sum over edges of length times middle
  double length_m = 0, lid_m2 = 0;
  std::vector<std::uint32_t> facets;  ///< the facet at each edge
};

bool isMissingFacet(Hole& hole) {
  std::sort(hole.facets.begin(), hole.facets.end());
  return hole.facets.size() == 3 &&
         std::adjacent_find(hole.facets.begin(), hole.facets.end()) == hole.facets.end();
}

double widestHole_m(const Mesh& once, const JoinedFacets& joined) {
  std::vector<HalfEdge> open;
  forEachEdge(joined.edges, [&](std::span<const HalfEdge> same) {
    if (same.size() == 1) open.push_back(same[0]);
  });
  Groups groups(once.vertices.size());
  for (const HalfEdge& e : open) groups.join(e.low, e.high);
  std::map<std::uint32_t, Hole> holes;
  const auto ends = [&](const HalfEdge& e) { return std::pair(once.vertices[e.low], once.vertices[e.high]); };
  for (const HalfEdge& e : open) {
    Hole& hole = holes[groups.find(e.low)];
    const auto [a, b] = ends(e);
    hole.center += 0.5 * (b - a).norm() * (a + b);
    hole.length_m += (b - a).norm();
    hole.facets.push_back(e.triangle);
  }
  for (const HalfEdge& e : open) {
    Hole& hole = holes[groups.find(e.low)];
    const auto [a, b] = ends(e);
    const Vec3 center = hole.center / hole.length_m;
    hole.lid_m2 += 0.5 * (a - center).cross(b - center).norm();
  }
  double widest_m = 0;
  for (auto& [group, hole] : holes)
    if (!isMissingFacet(hole)) widest_m = std::max(widest_m, 4 * hole.lid_m2 / hole.length_m);
  return widest_m;
}

/// True if the mesh has closed shells and every open shell is a sheet beside them.
bool isSolidBesideSheets(const Mesh& once, const JoinedFacets& joined) {
  Groups shells(once.triangles.size());
  std::vector<std::uint32_t> at_border;
  forEachEdge(joined.edges, [&](std::span<const HalfEdge> same) {
    for (const HalfEdge& e : same) shells.join(e.triangle, same[0].triangle);
    if (same.size() == 1) at_border.push_back(same[0].triangle);
  });
  std::vector<std::uint8_t> is_open(once.triangles.size(), 0);
  for (const std::uint32_t t : at_border) is_open[shells.find(t)] = 1;
  std::size_t open_facets = 0;
  for (std::uint32_t t = 0; t < once.triangles.size(); ++t) open_facets += is_open[shells.find(t)];
  return open_facets < once.triangles.size() && repairMesh(once).report.sheet_facets >= open_facets;
}

/// True if a mesh has a hole wider than wider_than_m, and so is a surface that other parts touch from both
/// sides. The width is four times the area of the hole's lid (see lidsOf()) over the length of its border:
/// the diameter of a round hole. Cracks and T-junctions count as closed, as in repairMesh(), and a hole of
/// three edges of different facets counts as a missing facet. The result is also false for a solid with free
/// sheets next to it, which repairMesh() recognises. Expects a mesh that requireUsable() accepts. O(n log n).
bool isOpenSurface(const Mesh& mesh, double wider_than_m) {
  const Mesh once = joinedOnce(mesh);
  const JoinedFacets joined = joinFacets(once, sortedHalfEdges(once), kWidestCrack);
  return joined.open_m > 0 && widestHole_m(once, joined) > wider_than_m && !isSolidBesideSheets(once, joined);
}

/// The facet next to a side of a facet, where exactly two facets meet. Lists of neighbours are indexed by 3 *
/// facet + side.
struct Neighbour {
  std::uint32_t facet = UINT32_MAX;
  std::uint8_t side = 0;
  bool agrees = true;  ///< the two facets agree on orientation, as given
};

std::vector<Neighbour> neighboursOf(const Mesh& mesh) {
  std::vector<Neighbour> beside(3 * mesh.triangles.size());
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    if (same.size() != 2) return;
    const bool agrees = same[0].is_forward != same[1].is_forward;
    for (const std::size_t i : {0U, 1U})
      beside[3 * std::size_t{same[i].triangle} + same[i].side] = {same[1 - i].triangle, same[1 - i].side,
                                                                  agrees};
  });
  return beside;
}

/// For each facet whether it must be turned to agree with the first facet of its piece, as far as possible.
std::vector<std::uint8_t> turnedFacets(std::size_t count, const std::vector<Neighbour>& beside) {
  std::vector<std::uint8_t> is_turned(count, 0), is_seen(count, 0);
  std::vector<std::uint32_t> next;
  for (std::uint32_t first = 0; first < count; ++first) {
    if (is_seen[first] != 0) continue;
    is_seen[first] = 1;
    next.assign(1, first);
    for (std::size_t i = 0; i < next.size(); ++i)
      for (int side = 0; side < 3; ++side) {
        const Neighbour& other = beside[3 * std::size_t{next[i]} + static_cast<std::size_t>(side)];
        if (other.facet == UINT32_MAX || is_seen[other.facet] != 0) continue;
        is_seen[other.facet] = 1;
        is_turned[other.facet] = is_turned[next[i]] ^ static_cast<std::uint8_t>(!other.agrees);
        next.push_back(other.facet);
      }
  }
  return is_turned;
}

/// Gives a vertex of its own to each group of corners that are connected by edges whose facets agree.
Mesh apart(const Mesh& mesh, const std::vector<Neighbour>& beside,
           const std::vector<std::uint8_t>& is_turned) {
  Groups corners(3 * mesh.triangles.size());
  const auto join = [&](std::size_t facet, std::uint32_t vertex, std::size_t other) {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        if (mesh.triangles[facet][k] == vertex && mesh.triangles[other][j] == vertex)
          corners.join(static_cast<std::uint32_t>(3 * facet + k), static_cast<std::uint32_t>(3 * other + j));
  };
  for (std::size_t facet = 0; facet < mesh.triangles.size(); ++facet)
    for (std::size_t side = 0; side < 3; ++side) {
      const Neighbour& other = beside[3 * facet + side];
      if (other.facet == UINT32_MAX || other.facet < facet) continue;
      if ((is_turned[facet] == is_turned[other.facet]) != other.agrees) continue;
      join(facet, mesh.triangles[facet][side], other.facet);
      join(facet, mesh.triangles[facet][(side + 1) % 3], other.facet);
    }
  const std::vector<std::uint32_t> vertex_of = corners.numbered();
  Mesh out;
  out.triangles.resize(mesh.triangles.size());
  for (std::size_t facet = 0; facet < mesh.triangles.size(); ++facet) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = vertex_of[3 * facet + k];
      if (v == out.vertices.size()) out.vertices.push_back(mesh.vertices[mesh.triangles[facet][k]]);
      out.triangles[facet][k] = v;
    }
    if (is_turned[facet] != 0) std::swap(out.triangles[facet][1], out.triangles[facet][2]);
  }
  return out;
}

/// The given surface: each facet once, narrow cracks closed, and facets turned to agree with their
/// neighbours. Vertices are shared only by facets that agree across edges of two facets, so that sheets that
/// meet along an edge, or that turn over like a Moebius strip, have separate normals there. O(n log n).
Mesh sheetSurface(const Mesh& mesh) {
  const Mesh once = joinedOnce(mesh);
  const std::vector<Neighbour> beside = neighboursOf(once);
  return apart(once, beside, turnedFacets(once.triangles.size(), beside));
}

void buildSheet(PartModel& model, Mesh mesh, const PointShellSettings& points) {
  auto solid = std::make_shared<const Solid>(Solid::sheet(sheetSurface(mesh)));
  model.shell = std::make_shared<const PointShell>(buildPointShell(*solid, points, model.name));
  model.mesh = std::make_shared<const Mesh>(std::move(mesh));
  model.solid = std::move(solid);
}

}  // namespace

std::shared_ptr<const PartModel> buildPartModel(const std::string& name, Mesh mesh,
                                                const VoxMapSettings& voxels,
                                                const PointShellSettings& points, const Material& material,
                                                OpenMesh open) {
  auto model = std::make_shared<PartModel>();
  model->name = name;
  model->material = material;
  requireUsable(mesh, "", name);
  if (open == OpenMesh::Sheet && isOpenSurface(mesh, points.spacing_m)) {
    buildSheet(*model, std::move(mesh), points);
    return model;
  }
  auto solid = std::make_shared<const Solid>(mesh, name);
  model->map = std::make_shared<const VoxMap>(buildVoxMap(*solid, voxels, name));
  model->shell = std::make_shared<const PointShell>(buildPointShell(*solid, points, name));
  const bool was_turned = solid->report().flipped_facets + solid->report().turned_shells > 0;
  if (was_turned) mesh = solid->interior() != nullptr ? solid->interior()->mesh() : solid->mesh();
  model->mesh = std::make_shared<const Mesh>(std::move(mesh));
  model->solid = std::move(solid);
  return model;
}

std::shared_ptr<const PartModel> withShell(const PartModel& model, std::shared_ptr<const PointShell> shell) {
  auto other = std::make_shared<PartModel>(model);
  other->shell = std::move(shell);
  return other;
}

}  // namespace vps
