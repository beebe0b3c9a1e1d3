// SPDX-License-Identifier: BSD-3-Clause
// Corners, sharp edges and facets of a part: the features at which two polyhedra first touch.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

struct CornerTree;
class EdgeTree;
struct FacetTree;

/// A sharp edge that is not a groove, or an edge that does not have exactly two facets. An edge is sharp if
/// it turns by 8 degrees or more, is a lone kink between two planes, or stands out by more than 0.5 um from
/// the curved surface that its facets approximate.
struct FeatureEdge {
  std::uint32_t from = 0, to = 0;               ///< vertices
  Vec3 into[2] = {Vec3::Zero(), Vec3::Zero()};  ///< unit, across the edge into each facet
  bool has_faces = false;                       ///< false: `into` is unknown
  /// At one of its ends the edge continues in exactly one other edge, which turns by less than 8 degrees.
  bool is_curved = false;
  /// The edge lies between two facets of one curved surface and stands out from it.
  bool is_slight = false;
  Vec3 normal[2] = {Vec3::Zero(), Vec3::Zero()};  ///< of each facet, outward, unit; zero if unknown
  bool has_curved_face[2] = {false, false};       ///< the facet approximates a curved surface
};

/// The features of one or several meshes in one frame, with a tree over each kind.
class VPS_API FeatureSet {
 public:
  FeatureSet();
  ~FeatureSet();
  FeatureSet(FeatureSet&&) noexcept;
  FeatureSet& operator=(FeatureSet&&) noexcept;

  /// Adds a mesh placed by X_MP; call build() afterwards. Facets without area are left out. O(n log n).
  /// @param is_sheet  true if other parts may touch the facets from both sides
  void append(const Mesh& mesh, const Pose& X_MP, bool is_sheet);
  /// O(n log n).
  void build();

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& facets() const { return facets_; }
  /// Outward unit normal.
  [[nodiscard]] const Vec3& normal(std::uint32_t facet) const { return normals_[facet]; }
  [[nodiscard]] bool isTwoSided(std::uint32_t facet) const { return (facet_flags_[facet] & kTwoSided) != 0; }
  /// True if the facet approximates a curved surface: it is one of three or more facets in a row that turn by
  /// less than 8 degrees each.
  [[nodiscard]] bool isCurved(std::uint32_t facet) const { return (facet_flags_[facet] & kCurved) != 0; }
  /// isCurved() for a triangle of a mesh; meshes are numbered in the order in which they were added. False
  /// for triangles without area.
  [[nodiscard]] bool isCurved(std::size_t mesh, std::uint32_t triangle) const {
    const std::uint32_t facet = facet_of_[first_triangle_[mesh] + triangle];
    return facet != kNone && isCurved(facet);
  }
  static constexpr std::uint32_t kNone = ~0U;
  /// The facets across the sides of a facet; side k runs from corner k to the next corner. kNone if a side
  /// has no neighbour or more than one.
  [[nodiscard]] const std::array<std::uint32_t, 3>& neighbours(std::uint32_t facet) const {
    return neighbours_[facet];
  }
  /// How far a curved edge leaves its segments near a vertex; 0 where no edge is curved.
  [[nodiscard]] double sagitta_m(std::uint32_t vertex) const { return sagitta_m_[vertex]; }
  [[nodiscard]] const std::vector<FeatureEdge>& edges() const { return edges_; }
  /// Vertices at which edges end.
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }
  [[nodiscard]] bool isEmpty() const { return facets_.empty(); }
  /// The edges that end at a corner, as indices of edges().
  [[nodiscard]] std::span<const std::uint32_t> edgesAt(std::uint32_t corner) const {
    return std::span(edges_at_).subspan(first_edge_[corner], first_edge_[corner + 1] - first_edge_[corner]);
  }
  /// Unit directions from a corner along the sides of the facets around it.
  [[nodiscard]] std::span<const Vec3> raysAt(std::uint32_t corner) const {
    return std::span(rays_).subspan(first_ray_[corner], first_ray_[corner + 1] - first_ray_[corner]);
  }
  /// True if the surface around the corner at a vertex lies behind the plane through the vertex with normal
  /// n, to within a slope of a thousandth. O(log n).
  /// @param n  unit, away from the part
  [[nodiscard]] bool isOutermostAt(std::uint32_t vertex, const Vec3& n) const;
  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] double radius_m() const { return 0.5 * box_.size().norm(); }

  /// The tree of the edges, for searches of FeatureMotion.
  [[nodiscard]] const EdgeTree& edgeTree() const;
  [[nodiscard]] const CornerTree& cornerTree() const;
  [[nodiscard]] const FacetTree& facetTree() const;

 private:
  void markCurvedEdges(std::size_t first);
  void buildRays(const std::vector<std::uint32_t>& corner_of);

  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> facets_;
  static constexpr std::uint8_t kTwoSided = 1, kCurved = 2;
  std::vector<Vec3> normals_;  // of facets
  std::vector<std::uint8_t> facet_flags_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<float> sagitta_m_;
  std::vector<std::uint32_t> facet_of_;      // the facet of each triangle of all meshes
  std::vector<std::size_t> first_triangle_;  // the first triangle of each mesh
  std::vector<FeatureEdge> edges_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> edges_at_, first_edge_;
  std::vector<Vec3> rays_;
  std::vector<std::uint32_t> first_ray_;
  Box box_;
  struct Trees;
  std::unique_ptr<const Trees> trees_;
};

}  // namespace vps
