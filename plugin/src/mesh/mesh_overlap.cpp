// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <algorithm>
#include <cmath>

#include "mesh/box_tree.h"
#include "mesh/facet_overlap.h"
#include "mesh/mesh_edges.h"
#include "vps/sharp_edges.h"

namespace vps::inline v0 {

namespace {

/// Rounding turns the diagonal of a flat face by about 1e-8; edges of curved surfaces turn by more than 1e-3.
constexpr double kFlat_rad = 1e-6;

std::vector<Box> boxesOf(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) boxes[i].add(mesh.vertices[v]);
  return boxes;
}

/// The first and the last triangle at each of some edges, which are in ascending order.
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

/// An edge of one solid in the frame of the other, and where it crosses the other's surface.
struct CrossedEdge {
  std::size_t index;  ///< among the edges of its solid
  Vec3 a, b;
  std::vector<double> crossings;
};

std::vector<CrossedEdge> edgesNear(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  std::vector<CrossedEdge> near;
  const std::vector<Vec3>& vertices = other.mesh().vertices;
  for (std::size_t i = 0; i < other.edges().size(); ++i) {
    const auto& [from, to] = other.edges()[i];
    CrossedEdge edge{i, X_SO * vertices[from], X_SO * vertices[to], {}};
    if (!meet(boxOf(edge.a, edge.b), in.box())) continue;
    in.appendCrossings(edge.a, edge.b, edge.crossings);
    near.push_back(std::move(edge));
  }
  return near;
}

double distanceToTriangle(const OverlapMesh& in, std::uint32_t triangle, const Vec3& p) {
  const auto& t = in.mesh().triangles[triangle];
  const auto& v = in.mesh().vertices;
  return (closestOnTriangle(p, v[t[0]], v[t[1]], v[t[2]]).q - p).norm();
}

/// Deepest point of segment ab, which is wholly inside or wholly outside, except where it passes a crack of
/// the mesh. The depth is the distance to the nearest triangle, so it is at most that to any one triangle,
/// which is convex along the segment: at most that of the farther end. A segment that lies along a face needs
/// one or two triangles, however long it is. Along with a distance that changes sign at a crack, depths are
/// found to within the crack's width. Returns false if the segment is outside and does not touch the surface.
bool searchSegment(const OverlapMesh& in, const Vec3& a, const Vec3& b, Deepest& deepest) {
  struct Piece {
    Vec3 a, b;
  };
  std::vector<Piece> stack{{a, b}};
  bool is_first = true;
  while (!stack.empty()) {
    const Piece piece = stack.back();
    stack.pop_back();
    const Vec3 middle = 0.5 * (piece.a + piece.b);
    const Solid::Closest nearest = in.solid().closest(middle);
    const bool is_outside = nearest.normal.dot(middle - nearest.q) > 0;
    if (is_first && is_outside) return nearest.distance_m <= kOverlapCertain_m;
    is_first = false;
    const double farther_end_m = std::max(distanceToTriangle(in, nearest.triangle, piece.a),
                                          distanceToTriangle(in, nearest.triangle, piece.b));
    const double half_m = 0.5 * (piece.b - piece.a).norm();
    const double signed_m = is_outside ? -nearest.distance_m : nearest.distance_m;
    if (std::min(farther_end_m, signed_m + half_m) <= deepest.depth_m + kOverlapCertain_m) continue;
    if (signed_m > deepest.depth_m) deepest = {signed_m, middle};
    stack.push_back({piece.a, middle});
    stack.push_back({middle, piece.b});
  }
  return true;
}

/// Returns those edges, by index, that are not wholly outside of the surface.
std::vector<std::size_t> searchEdges(const OverlapMesh& in, std::vector<CrossedEdge>& edges,
                                     Deepest& deepest) {
  std::vector<std::size_t> touching;
  for (CrossedEdge& edge : edges) {
    std::sort(edge.crossings.begin(), edge.crossings.end());
    edge.crossings.push_back(1);
    double from = 0;
    bool may_touch = false;
    for (const double to : edge.crossings) {
      if (to > from)
        may_touch |= searchSegment(in, at(edge.a, edge.b, from), at(edge.a, edge.b, to), deepest);
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

/// True if the first vertex is outside and does not touch the surface.
bool isClearlyOutside(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  const Vec3 p = X_SO * other.mesh().vertices.front();
  return !meet(boxOf(p, p), in.box()) || in.solid().signedDistance(p) > kOverlapCertain_m;
}

}  // namespace

struct OverlapMesh::Triangles {
  explicit Triangles(const Mesh& mesh) : boxes(boxesOf(mesh)), tree(boxes) {}
  std::vector<Box> boxes;
  BoxTree tree;
};

OverlapMesh::OverlapMesh(std::shared_ptr<const Solid> solid)
    : solid_(std::move(solid)),
      box_(bounds(solid_->mesh())),
      edges_(sharpEdges(solid_->mesh(), kFlat_rad)),
      triangles_at_edges_(trianglesAt(edges_, solid_->mesh())),
      triangles_(std::make_unique<const Triangles>(solid_->mesh())) {}

OverlapMesh::~OverlapMesh() = default;
OverlapMesh::OverlapMesh(OverlapMesh&&) noexcept = default;
OverlapMesh& OverlapMesh::operator=(OverlapMesh&&) noexcept = default;

void OverlapMesh::appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const {
  // Barycentric coordinates round by about 1e-15; a crossing at a shared border must not fall between both.
  constexpr double kBorder = -1e-12;
  triangles_->tree.forEachOverlap(boxOf(a, b), [&](std::uint32_t i) {
    const auto& t = mesh().triangles[i];
    const Vec3& corner = mesh().vertices[t[0]];
    const Vec3 u = mesh().vertices[t[1]] - corner, v = mesh().vertices[t[2]] - corner, n = u.cross(v);
    const double above_a = n.dot(a - corner), above_b = n.dot(b - corner);
    if ((above_a > 0) == (above_b > 0)) return true;
    const double fraction = above_a / (above_a - above_b);
    const Vec3 q = at(a, b, fraction) - corner;
    const double n2 = n.squaredNorm();
    const double along_u = q.cross(v).dot(n) / n2, along_v = u.cross(q).dot(n) / n2;
    if (along_u >= kBorder && along_v >= kBorder && along_u + along_v <= 1 - kBorder) out.push_back(fraction);
    return true;
  });
}

Overlap deepestOverlap(const OverlapMesh& a, const Pose& X_WA, const OverlapMesh& b, const Pose& X_WB) {
  const Pose X_AB = X_WA.inverse() * X_WB, X_BA = X_AB.inverse();
  if (!meet(moved(b.box(), X_AB), a.box()) || !meet(moved(a.box(), X_BA), b.box())) return {};
  std::vector<CrossedEdge> of_b = edgesNear(a, b, X_AB), of_a = edgesNear(b, a, X_BA);
  if (!isAnyCrossed(of_b) && !isAnyCrossed(of_a) && isClearlyOutside(a, b, X_AB) &&
      isClearlyOutside(b, a, X_BA))
    return {};
  Deepest in_a, in_b;
  const std::vector<std::size_t> edges_b = searchEdges(a, of_b, in_a);
  in_b.depth_m = in_a.depth_m;
  const std::vector<std::size_t> edges_a = searchEdges(b, of_a, in_b);
  Overlap deepest = in_b.depth_m > in_a.depth_m ? Overlap{in_b.depth_m, X_WB * in_b.p_S}
                                                : Overlap{in_a.depth_m, X_WA * in_a.p_S};
  // Between edges: first all facets, then below those that are flush.
  bool is_between_edges = false;
  const auto keep = [&](const Pose& X_WS, const auto& search) {
    Deepest found{deepest.depth_m, Vec3::Zero(), is_between_edges};
    search(found);
    if (found.depth_m > deepest.depth_m) deepest = {found.depth_m, X_WS * found.p_S};
    is_between_edges = found.is_between_edges;
  };
  std::vector<FlushPoint> flush_b, flush_a;
  keep(X_WA, [&](Deepest& found) { flush_b = searchFacets(a, b, X_AB, trianglesAt(b, edges_b), found); });
  keep(X_WB, [&](Deepest& found) { flush_a = searchFacets(b, a, X_BA, trianglesAt(a, edges_a), found); });
  keep(X_WA, [&](Deepest& found) { searchBelow(a, b, X_AB, flush_b, found); });
  keep(X_WB, [&](Deepest& found) { searchBelow(b, a, X_BA, flush_a, found); });
  return deepest;
}

}  // namespace vps::inline v0
