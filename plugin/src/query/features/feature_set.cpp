// SPDX-License-Identifier: BSD-3-Clause
#include "vps/feature_set.h"

#include <algorithm>
#include <limits>
#include <span>

#include "mesh/mesh_edges.h"
#include "mesh/normals.h"
#include "query/features/curved_features.h"
#include "query/features/touch_search.h"
#include "vps/contact_tolerances.h"
#include "vps/edge_tree.h"

namespace vps {

struct FeatureSet::Trees {
  explicit Trees(const FeatureSet& part) : edges(linesOf(part)) {
    corners.build(part);
    facets.build(part);
  }
  static std::vector<EdgeTree::Line> linesOf(const FeatureSet& part) {
    std::vector<EdgeTree::Line> lines;
    for (const FeatureEdge& edge : part.edges())
      lines.push_back({part.vertices()[edge.from], part.vertices()[edge.to]});
    return lines;
  }

  EdgeTree edges;
  CornerTree corners;
  FacetTree facets;
};

FeatureSet::FeatureSet() {
  build();
}
FeatureSet::~FeatureSet() = default;
FeatureSet::FeatureSet(FeatureSet&&) noexcept = default;
FeatureSet& FeatureSet::operator=(FeatureSet&&) noexcept = default;

void FeatureSet::append(const Mesh& mesh, const Pose& X_MP, bool is_sheet) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (const Vec3& p : mesh.vertices) vertices_.push_back(X_MP * p);
  sagitta_m_.resize(vertices_.size(), 0);
  const auto vertex = [&](std::uint32_t i) -> const Vec3& { return vertices_[first + i]; };
  first_triangle_.push_back(facet_of_.size());
  facet_of_.resize(facet_of_.size() + mesh.triangles.size(), kNone);
  const std::span<std::uint32_t> facet_of = std::span(facet_of_).subspan(first_triangle_.back());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (!hasArea(vertex(t[0]), vertex(t[1]), vertex(t[2]))) continue;
    facets_.push_back({first + t[0], first + t[1], first + t[2]});
    facet_of[i] = static_cast<std::uint32_t>(facet_flags_.size());
    facet_flags_.push_back(is_sheet ? kTwoSided : 0);
    const auto& [a, b, c] = facets_.back();
    normals_.push_back((vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]).normalized());
    neighbours_.push_back({kNone, kNone, kNone});
  }
  const std::size_t first_edge = edges_.size();
  std::vector<std::uint32_t> facets_beside;  // two entries for each edge
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh);
  std::vector<Vec3> normals(mesh.triangles.size(), Vec3::Zero());
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (facet_of[i] != kNone) normals[i] = normals_[facet_of[i]];
  std::vector<std::uint8_t> is_curved(mesh.triangles.size(), 0);
  if (!is_sheet) is_curved = findCurvedFacets(half_edges, normals);
  for (std::size_t i = 0; i < is_curved.size(); ++i)
    if (is_curved[i] != 0 && facet_of[i] != kNone) facet_flags_[facet_of[i]] |= kCurved;
  forEachEdge(half_edges, [&](std::span<const HalfEdge> same) {
    if (same.size() == 2)
      for (const std::size_t i : {0U, 1U})
        if (const std::uint32_t facet = facet_of[same[i].triangle]; facet != kNone)
          neighbours_[facet][same[i].side] = facet_of[same[1 - i].triangle];
    FeatureEdge edge;
    edge.from = first + same[0].low;
    edge.to = first + same[0].high;
    const Vec3 way = vertices_[edge.to] - vertices_[edge.from];
    if (!(way.squaredNorm() > 0)) return;
    const Vec3 along = way.normalized();
    edge.has_faces = same.size() == 2 && same[0].is_forward != same[1].is_forward && !is_sheet;
    double width_m = std::numeric_limits<double>::infinity();  // of the narrower facet, across the edge
    for (std::size_t i = 0; i < 2 && i < same.size(); ++i) {
      const std::uint32_t triangle = same[i].triangle;
      if (facet_of[triangle] == kNone) {
        edge.has_faces = false;
        continue;
      }
      edge.normal[i] = normals[triangle];
      const Vec3 into = vertex(mesh.triangles[triangle][(same[i].side + 2U) % 3]) - vertices_[edge.from];
      const Vec3 across = into - along * along.dot(into);
      edge.into[i] = across.normalized();
      width_m = std::min(width_m, across.norm());
    }
    const bool is_joined = same.size() == 2 && same[0].is_forward != same[1].is_forward;
    if (is_sheet && is_joined && isSmoothEdge(edge.normal[0], edge.normal[1], false, 0)) return;
    if (edge.has_faces) {
      const bool is_one_curved = is_curved[same[0].triangle] != 0 || is_curved[same[1].triangle] != 0;
      if (isSmoothEdge(edge.normal[0], edge.normal[1], is_one_curved, width_m)) return;
      edge.is_slight = isSmoothEdge(edge.normal[0], edge.normal[1], is_one_curved, 0);
      if (!(edge.normal[0].dot(edge.into[1]) < 0)) return;  // a groove
    }
    for (std::size_t i = 0; i < 2 && i < same.size(); ++i)
      facets_beside.push_back(facet_of[same[i].triangle]);
    facets_beside.resize(2 * (edges_.size() + 1 - first_edge), kNone);
    edges_.push_back(edge);
    corners_.push_back(edge.from);
    corners_.push_back(edge.to);
  });
  markCurvedEdges(first_edge);
  for (std::size_t i = 0; i < facets_beside.size(); ++i)
    edges_[first_edge + i / 2].has_curved_face[i % 2] =
        facets_beside[i] != kNone && isCurved(facets_beside[i]);
}

void FeatureSet::markCurvedEdges(std::size_t first) {
  std::vector<EdgeEnd> ends;
  for (std::size_t i = first; i < edges_.size(); ++i) {
    const auto edge = static_cast<std::uint32_t>(i);
    const Vec3 along = (vertices_[edges_[i].to] - vertices_[edges_[i].from]).normalized();
    ends.push_back({edges_[i].from, edge, 0, along});
    ends.push_back({edges_[i].to, edge, 1, -along});
  }
  forEachJoint(ends, [&](const EdgeEnd& a, const EdgeEnd& b) {
    const double sine = a.away.cross(b.away).norm();
    if (!(sine > kSinFlat && a.away.dot(b.away) < -kCosCurved)) return;
    double length_m = 0;
    for (const EdgeEnd* e : {&a, &b}) {
      FeatureEdge& edge = edges_[e->edge];
      edge.is_curved = true;
      length_m = std::max(length_m, (vertices_[edge.to] - vertices_[edge.from]).norm());
    }
    // The sagitta of an arc that turns by an angle over a length is length times angle / 8.
    sagitta_m_[a.vertex] = static_cast<float>(length_m * sine / 8);
  });
}

void FeatureSet::build() {
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  std::vector<std::uint32_t> corner_of(vertices_.size(), kNone);
  for (std::uint32_t i = 0; i < corners_.size(); ++i) corner_of[corners_[i]] = i;
  first_edge_.assign(corners_.size() + 1, 0);
  const auto forEachEnd = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < edges_.size(); ++i)
      for (const std::uint32_t v : {edges_[i].from, edges_[i].to}) visit(i, corner_of[v]);
  };
  forEachEnd([&](std::uint32_t, std::uint32_t corner) { ++first_edge_[corner + 1]; });
  for (std::size_t i = 1; i < first_edge_.size(); ++i) first_edge_[i] += first_edge_[i - 1];
  edges_at_.resize(first_edge_.back());
  std::vector<std::uint32_t> next(first_edge_.begin(), first_edge_.end() - 1);
  forEachEnd([&](std::uint32_t edge, std::uint32_t corner) { edges_at_[next[corner]++] = edge; });

  buildRays(corner_of);

  box_ = Box();
  for (const Vec3& p : vertices_) box_.add(p);
  trees_ = std::make_unique<const Trees>(*this);
}

void FeatureSet::buildRays(const std::vector<std::uint32_t>& corner_of) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      sides;  // a corner, and the vertex at a side's other end
  for (const auto& t : facets_)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t corner = corner_of[t[k]]; corner != kNone) {
        sides.emplace_back(corner, t[(k + 1) % 3]);
        sides.emplace_back(corner, t[(k + 2) % 3]);
      }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  rays_.clear();
  first_ray_.assign(corners_.size() + 1, 0);
  for (const auto& [corner, end] : sides) {
    const Vec3 way = vertices_[end] - vertices_[corners_[corner]];
    if (!(way.squaredNorm() > 0)) continue;
    rays_.push_back(way.normalized());
    ++first_ray_[corner + 1];
  }
  for (std::size_t i = 1; i < first_ray_.size(); ++i) first_ray_[i] += first_ray_[i - 1];
}

bool FeatureSet::isOutermostAt(std::uint32_t vertex, const Vec3& n) const {
  const auto corner = std::lower_bound(corners_.begin(), corners_.end(), vertex);
  if (corner == corners_.end() || *corner != vertex) return false;
  const std::span<const Vec3> rays = raysAt(static_cast<std::uint32_t>(corner - corners_.begin()));
  return std::all_of(rays.begin(), rays.end(), [&](const Vec3& ray) { return n.dot(ray) < kSinParallel; });
}

const EdgeTree& FeatureSet::edgeTree() const {
  return trees_->edges;
}

const CornerTree& FeatureSet::cornerTree() const {
  return trees_->corners;
}

const FacetTree& FeatureSet::facetTree() const {
  return trees_->facets;
}

}  // namespace vps
