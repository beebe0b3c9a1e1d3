// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/mesh_edges.h"
#include "mesh/overlap/overlap_search.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps/stoppable.h"

namespace vps {

struct EdgeGroups {
  explicit EdgeGroups(std::vector<Box> of_groups) : boxes(std::move(of_groups)), tree(boxes) {}
  EdgeGroups(const EdgeGroups&) = delete;
  EdgeGroups& operator=(const EdgeGroups&) = delete;

  /// The groups whose boxes share a point with `box`, in ascending order. The box is grown by rounding
  /// errors.
  [[nodiscard]] std::vector<std::uint32_t> near(const Box& box) const {
    std::vector<std::uint32_t> found;
    tree.forEachOverlap(boxes, grown(box, 1e-9 * box.size().norm()), [&](std::uint32_t group) {
      found.push_back(group);
      return true;
    });
    std::sort(found.begin(), found.end());
    return found;
  }

  std::vector<Box> boxes;
  BoxTree tree;  ///< a tree over `boxes`
};

namespace {

/// Rounding turns the diagonal of a flat face by about 1e-8 rad; edges of curved surfaces turn by more than
/// 1e-3.
constexpr double kFlat_rad = 1e-6;

/// The first and the last triangle at each of the given edges, which are in ascending order.
std::vector<std::array<std::uint32_t, 2>> trianglesAt(const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                      const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> triangles;
  triangles.reserve(edges.size());
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    if (triangles.size() == edges.size()) return;
    const auto& [low, high] = edges[triangles.size()];
    if (sides[0].low == low && sides[0].high == high)
      triangles.push_back({sides.front().triangle, sides.back().triangle});
  });
  return triangles;
}

Box boxOf(const Vec3& a, const Vec3& b) {
  Box box;
  box.add(a);
  box.add(b);
  return box;
}

Vec3 at(const Vec3& a, const Vec3& b, double fraction) {
  return a + fraction * (b - a);
}

/// Edges in a group. Edges of near numbers are mostly near each other, since vertices are numbered along the
/// surface.
constexpr std::size_t kGroup = 16;

std::vector<Box> groupBoxes(const std::vector<std::array<std::uint32_t, 2>>& edges, const Mesh& mesh) {
  std::vector<Box> boxes((edges.size() + kGroup - 1) / kGroup);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const std::uint32_t vertex : edges[i]) boxes[i / kGroup].add(mesh.vertices[vertex]);
  return boxes;
}

/// An edge of one solid in the frame of the other, and where it crosses the other's surface.
struct CrossedEdge {
  std::size_t index;  ///< among the edges of its solid
  Vec3 a, b;
  std::vector<double> crossings;
};

std::vector<CrossedEdge> edgesNear(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  std::vector<CrossedEdge> near;
  const std::vector<Vec3>& vertices = other.mesh().vertices;
  for (const std::uint32_t group : other.groups().near(moved(in.box(), X_SO.inverse()))) {
    pollStop();
    for (std::size_t i = kGroup * group; i < std::min(kGroup * (group + 1), other.edges().size()); ++i) {
      const auto& [from, to] = other.edges()[i];
      CrossedEdge edge{i, X_SO * vertices[from], X_SO * vertices[to], {}};
      if (!overlap(boxOf(edge.a, edge.b), in.box())) continue;
      in.solid().appendCrossings(edge.a, edge.b, edge.crossings);
      near.push_back(std::move(edge));
    }
  }
  return near;
}

/// Returns the edges, by index, that are not wholly outside of the surface.
std::vector<std::size_t> searchEdges(const OverlapMesh& in, std::vector<CrossedEdge>& edges,
                                     Deepest& deepest) {
  std::vector<std::size_t> touching;
  for (CrossedEdge& edge : edges) {
    pollStop();
    std::sort(edge.crossings.begin(), edge.crossings.end());
    edge.crossings.push_back(1);
    double from = 0;
    bool may_touch = false;
    for (const double to : edge.crossings) {
      if (to > from)
        may_touch |= searchUncrossed(in.solid(), at(edge.a, edge.b, from), at(edge.a, edge.b, to),
                                     kOverlapCertain_m, deepest.depth_m, deepest.p_S);
      from = to;
    }
    if (may_touch) touching.push_back(edge.index);
  }
  return touching;
}

std::vector<std::uint32_t> trianglesAt(const OverlapMesh& mesh, const std::vector<std::size_t>& edges) {
  std::vector<std::uint32_t> triangles;
  for (const std::size_t edge : edges)
    for (const std::uint32_t triangle : mesh.trianglesAtEdges()[edge]) triangles.push_back(triangle);
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

bool isAnyCrossed(const std::vector<CrossedEdge>& edges) {
  return std::any_of(edges.begin(), edges.end(), [](const CrossedEdge& e) { return !e.crossings.empty(); });
}

/// Finds the depth of a sheet in a solid. The first guess is the middle of the places where the solid's edges
/// cross the sheet, because these surround the part of the sheet that is inside.
/// @param crossed  edges of the solid in the sheet's frame
void searchSheet(const OverlapMesh& sheet, const OverlapMesh& solid, const Pose& X_SolidSheet,
                 const std::vector<CrossedEdge>& crossed, Deepest& deepest) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const CrossedEdge& edge : crossed)
    for (const double fraction : edge.crossings) {
      if (fraction == 1) continue;  // not a crossing: the end of the edge, added by searchEdges()
      sum += at(edge.a, edge.b, fraction);
      ++count;
    }
  if (count == 0) return;
  const Vec3 p_S = X_SolidSheet * sheet.solid().closest(sum / count).q;
  if (const double depth_m = -solid.solid().signedDistance(p_S); depth_m > deepest.depth_m)
    deepest = {depth_m, p_S, true};
  deepest.is_between_edges = true;
  std::vector<std::uint32_t> facets(sheet.mesh().triangles.size());
  std::iota(facets.begin(), facets.end(), 0U);
  searchFacets(solid, sheet, X_SolidSheet, facets, deepest);
}

bool hasSheets(const Solid& solid) {
  return solid.isSheet() || solid.report().sheet_facets > 0;
}

std::size_t workOf(const std::vector<CrossedEdge>& edges) {
  std::size_t work = edges.size();
  for (const CrossedEdge& edge : edges) work += 3 * edge.crossings.size();
  return work;
}

/// True if the first vertex of `other` is outside of `in` and does not touch its surface.
bool isClearlyOutside(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  const Vec3 p = X_SO * other.mesh().vertices.front();
  return !overlap(boxOf(p, p), in.box()) || in.solid().signedDistance(p) > kOverlapCertain_m;
}

}  // namespace

OverlapMesh::OverlapMesh(std::shared_ptr<const Solid> solid)
    : solid_(std::move(solid)),
      box_(bounds(solid_->mesh())),
      edges_(sharpEdges(solid_->mesh(), kFlat_rad)),
      triangles_at_edges_(trianglesAt(edges_, solid_->mesh())),
      groups_(std::make_shared<const EdgeGroups>(groupBoxes(edges_, solid_->mesh()))) {}

Overlap deepestOverlap(const OverlapMesh& a, const Pose& X_WA, const OverlapMesh& b, const Pose& X_WB,
                       bool with_sheets) {
  const Pose X_AB = X_WA.inverse() * X_WB, X_BA = X_AB.inverse();
  if (!overlap(moved(b.box(), X_AB), a.box()) || !overlap(moved(a.box(), X_BA), b.box())) return {};
  std::vector<CrossedEdge> of_b = edgesNear(a, b, X_AB), of_a = edgesNear(b, a, X_BA);
  std::size_t work = 4 + workOf(of_a) + workOf(of_b);
  if (!isAnyCrossed(of_b) && !isAnyCrossed(of_a) && isClearlyOutside(a, b, X_AB) &&
      isClearlyOutside(b, a, X_BA))
    return {0, Vec3::Zero(), work};
  Deepest in_a, in_b;
  const std::vector<std::size_t> edges_b = searchEdges(a, of_b, in_a);
  in_b.depth_m = in_a.depth_m;
  const std::vector<std::size_t> edges_a = searchEdges(b, of_a, in_b);
  Overlap deepest = in_b.depth_m > in_a.depth_m ? Overlap{in_b.depth_m, X_WB * in_b.p_S, 0}
                                                : Overlap{in_a.depth_m, X_WA * in_a.p_S, 0};
  deepest.work = work + 4 * (edges_a.size() + edges_b.size());
  // Search between edges: first in all facets, then below flush facets.
  bool is_between_edges = false;
  const auto keep = [&](const Pose& X_WS, const auto& search) {
    Deepest found{deepest.depth_m, Vec3::Zero(), is_between_edges};
    search(found);
    if (found.depth_m > deepest.depth_m) deepest = {found.depth_m, X_WS * found.p_S, deepest.work};
    is_between_edges = found.is_between_edges;
  };
  std::vector<FlushPoint> flush_b, flush_a;
  keep(X_WA, [&](Deepest& found) { flush_b = searchFacets(a, b, X_AB, trianglesAt(b, edges_b), found); });
  keep(X_WB, [&](Deepest& found) { flush_a = searchFacets(b, a, X_BA, trianglesAt(a, edges_a), found); });
  keep(X_WA, [&](Deepest& found) { searchBelow(a, b, X_AB, flush_b, found); });
  keep(X_WB, [&](Deepest& found) { searchBelow(b, a, X_BA, flush_a, found); });
  if (with_sheets && hasSheets(b.solid()))
    keep(X_WA, [&](Deepest& found) { searchSheet(b, a, X_AB, of_a, found); });
  if (with_sheets && hasSheets(a.solid()))
    keep(X_WB, [&](Deepest& found) { searchSheet(a, b, X_BA, of_b, found); });
  return deepest;
}

}  // namespace vps
