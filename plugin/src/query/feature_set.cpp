// SPDX-License-Identifier: BSD-3-Clause
#include "vps/feature_set.h"

#include <algorithm>
#include <span>

#include "mesh/mesh_edges.h"
#include "query/sphere_tree.h"

namespace vps::inline v0 {

namespace {

constexpr double kCosSharp = 0.94;      // 20 degrees, as PointShellSettings::edge_angle_rad
constexpr double kFlat = 1e-4;          // sine; assumed: above the rounding of files in single precision
constexpr double kMinSlimness = 1e-10;  // as MeshDistance: twice the area over the longest edge's square

bool hasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() > kMinSlimness * longest2;
}

}  // namespace

FeatureSet::FeatureSet() {
  build();
}
FeatureSet::~FeatureSet() = default;
FeatureSet::FeatureSet(FeatureSet&&) noexcept = default;
FeatureSet& FeatureSet::operator=(FeatureSet&&) noexcept = default;

void FeatureSet::append(const Mesh& mesh, const Pose& X_MP, bool is_sheet) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (const Vec3& p : mesh.vertices) vertices_.push_back(X_MP * p);
  const auto vertex = [&](std::uint32_t i) -> const Vec3& { return vertices_[first + i]; };
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> facet_of(mesh.triangles.size(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (!hasArea(vertex(t[0]), vertex(t[1]), vertex(t[2]))) continue;
    facets_.push_back({first + t[0], first + t[1], first + t[2]});
    facet_of[i] = static_cast<std::uint32_t>(facet_flags_.size());
    facet_flags_.push_back(is_sheet ? kTwoSided : 0);
  }
  const std::size_t first_edge = edges_.size();
  Groups planes(mesh.triangles.size());
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    FeatureEdge edge;
    edge.from = first + same[0].low;
    edge.to = first + same[0].high;
    const Vec3 way = vertices_[edge.to] - vertices_[edge.from];
    if (!(way.squaredNorm() > 0)) return;
    const Vec3 along = way.normalized();
    edge.has_faces = same.size() == 2 && same[0].is_forward != same[1].is_forward && !is_sheet;
    Vec3 normal[2] = {Vec3::Zero(), Vec3::Zero()};
    for (std::size_t i = 0; i < 2 && i < same.size(); ++i) {
      const auto& t = mesh.triangles[same[i].triangle];
      const Vec3 &a = vertex(t[0]), &b = vertex(t[1]), &c = vertex(t[2]);
      if (!hasArea(a, b, c)) {
        edge.has_faces = false;
        continue;
      }
      normal[i] = (b - a).cross(c - a).normalized();
      const Vec3 into = vertex(t[(same[i].side + 2U) % 3]) - vertices_[edge.from];
      edge.into[i] = (into - along * along.dot(into)).normalized();
    }
    if (edge.has_faces && normal[0].dot(normal[1]) >= kCosSharp) {
      if (normal[0].cross(normal[1]).norm() > kFlat)
        for (const HalfEdge& e : same) facet_flags_[facet_of[e.triangle]] |= kCurved;
      else
        planes.join(same[0].triangle, same[1].triangle);
      return;
    }
    if (edge.has_faces && !(normal[0].dot(edge.into[1]) < 0)) return;  // a groove
    edges_.push_back(edge);
    corners_.push_back(edge.from);
    corners_.push_back(edge.to);
  });
  markCurvedEdges(first_edge);
  // Triangles of one plane are one facet.
  std::vector<std::uint8_t> is_curved(mesh.triangles.size(), 0);
  for (std::uint32_t i = 0; i < facet_of.size(); ++i)
    if (facet_of[i] != kNone && isCurved(facet_of[i])) is_curved[planes.find(i)] = 1;
  for (std::uint32_t i = 0; i < facet_of.size(); ++i)
    if (facet_of[i] != kNone && is_curved[planes.find(i)] != 0) facet_flags_[facet_of[i]] |= kCurved;
}

void FeatureSet::markCurvedEdges(std::size_t first) {
  struct End {
    std::uint32_t vertex, edge;
    Vec3 away;
  };
  std::vector<End> ends;
  for (std::size_t i = first; i < edges_.size(); ++i) {
    const auto edge = static_cast<std::uint32_t>(i);
    const Vec3 along = (vertices_[edges_[i].to] - vertices_[edges_[i].from]).normalized();
    ends.push_back({edges_[i].from, edge, along});
    ends.push_back({edges_[i].to, edge, -along});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
  });
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t end = i + 1;
    while (end < ends.size() && ends[end].vertex == ends[i].vertex) ++end;
    if (end - i == 2 && ends[i].away.dot(ends[i + 1].away) < -kCosSharp &&
        ends[i].away.cross(ends[i + 1].away).norm() > kFlat)
      edges_[ends[i].edge].is_curved = edges_[ends[i + 1].edge].is_curved = true;
    i = end;
  }
}

void FeatureSet::build() {
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  std::vector<std::uint8_t> is_curved(vertices_.size(), 0);
  for (const FeatureEdge& edge : edges_)
    if (edge.is_curved) is_curved[edge.from] = is_curved[edge.to] = 1;
  std::vector<std::uint32_t> items[3][2];
  const auto sort = [&](Kind kind, std::size_t count, const auto& isOneCurved) {
    for (std::uint32_t i = 0; i < count; ++i) items[kind][isOneCurved(i) ? 1 : 0].push_back(i);
  };
  sort(kCorners, corners_.size(), [&](std::uint32_t i) { return is_curved[corners_[i]] != 0; });
  sort(kEdges, edges_.size(), [&](std::uint32_t i) { return edges_[i].is_curved; });
  sort(kFacets, facets_.size(), [&](std::uint32_t i) { return isCurved(i); });
  for (int k = 0; k < 2; ++k) {
    trees_[kCorners][k] = std::make_unique<const SphereTree>(
        items[kCorners][k], [&](std::uint32_t i, const auto& visit) { visit(vertices_[corners_[i]]); });
    trees_[kEdges][k] =
        std::make_unique<const SphereTree>(items[kEdges][k], [&](std::uint32_t i, const auto& visit) {
          visit(vertices_[edges_[i].from]);
          visit(vertices_[edges_[i].to]);
        });
    trees_[kFacets][k] =
        std::make_unique<const SphereTree>(items[kFacets][k], [&](std::uint32_t i, const auto& visit) {
          for (const std::uint32_t v : facets_[i]) visit(vertices_[v]);
        });
  }
  Box box;
  for (const Vec3& p : vertices_) box.add(p);
  center_ = vertices_.empty() ? Vec3(Vec3::Zero()) : box.center();
  radius_m_ = 0;
  for (const Vec3& p : vertices_) radius_m_ = std::max(radius_m_, (p - center_).norm());
}

}  // namespace vps::inline v0
