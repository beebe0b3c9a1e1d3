// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_overlap.h"

#include <algorithm>
#include <cmath>

#include "mesh/box_tree.h"
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
  Vec3 a, b;
  std::vector<double> crossings;
};

std::vector<CrossedEdge> edgesNear(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  std::vector<CrossedEdge> near;
  const std::vector<Vec3>& vertices = other.mesh().vertices;
  for (const auto& [from, to] : other.edges()) {
    CrossedEdge edge{X_SO * vertices[from], X_SO * vertices[to], {}};
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

struct Deepest {
  double depth_m = 0;
  Vec3 p_S = Vec3::Zero();
};

/// Deepest point of segment ab, which is wholly inside or wholly outside. The depth is the distance to the
/// nearest triangle, so it is at most that to any one triangle, which is convex along the segment: at most
/// that of the farther end. A segment that lies along a face needs one or two triangles, however long it is.
void searchSegment(const OverlapMesh& in, const Vec3& a, const Vec3& b, Deepest& deepest) {
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
    const double farther_end_m = std::max(distanceToTriangle(in, nearest.triangle, piece.a),
                                          distanceToTriangle(in, nearest.triangle, piece.b));
    const double half_m = 0.5 * (piece.b - piece.a).norm();
    if (std::min(farther_end_m, nearest.distance_m + half_m) <= deepest.depth_m + kOverlapCertain_m) continue;
    if (is_first && nearest.normal.dot(middle - nearest.q) > 0) return;  // outside
    is_first = false;
    if (nearest.distance_m > deepest.depth_m) deepest = {nearest.distance_m, middle};
    stack.push_back({piece.a, middle});
    stack.push_back({middle, piece.b});
  }
}

void searchEdges(const OverlapMesh& in, std::vector<CrossedEdge>& edges, Deepest& deepest) {
  for (CrossedEdge& edge : edges) {
    std::sort(edge.crossings.begin(), edge.crossings.end());
    edge.crossings.push_back(1);
    double from = 0;
    for (const double to : edge.crossings) {
      if (to > from) searchSegment(in, at(edge.a, edge.b, from), at(edge.a, edge.b, to), deepest);
      from = to;
    }
  }
}

bool isAnyCrossed(const std::vector<CrossedEdge>& edges) {
  return std::any_of(edges.begin(), edges.end(), [](const CrossedEdge& e) { return !e.crossings.empty(); });
}

bool isWithinSolid(const OverlapMesh& in, const OverlapMesh& other, const Pose& X_SO) {
  const Vec3 p = X_SO * other.mesh().vertices.front();
  return meet(boxOf(p, p), in.box()) && in.solid().signedDistance(p) < 0;
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
  if (!isAnyCrossed(of_b) && !isAnyCrossed(of_a) && !isWithinSolid(a, b, X_AB) && !isWithinSolid(b, a, X_BA))
    return {};
  Deepest in_a, in_b;
  searchEdges(a, of_b, in_a);
  in_b.depth_m = in_a.depth_m;
  searchEdges(b, of_a, in_b);
  if (in_b.depth_m > in_a.depth_m) return {in_b.depth_m, X_WB * in_b.p_S};
  return {in_a.depth_m, X_WA * in_a.p_S};
}

}  // namespace vps::inline v0
