// SPDX-License-Identifier: BSD-3-Clause
// Corners, sharp edges and facets of a part: what two polyhedra first touch with.
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

/// A sharp edge that is not a groove, or an edge that does not have exactly two facets. Sharp are edges that
/// turn by 8 degrees or more, lone kinks between two planes, and edges that stand out by more than 0.5 um
/// from the curved surface that their facets stand for.
struct FeatureEdge {
  std::uint32_t from = 0, to = 0;               ///< vertices
  Vec3 into[2] = {Vec3::Zero(), Vec3::Zero()};  ///< unit, across the edge into each facet
  bool has_faces = false;                       ///< false: `into` is unknown
  /// At an end it goes on in one other edge, which turns by less than 8 degrees.
  bool is_curved = false;
  /// Between two facets of one curved surface, from which it stands out.
  bool is_slight = false;
  Vec3 normal[2] = {Vec3::Zero(), Vec3::Zero()};  ///< of each facet, outward, unit; zero if unknown
  bool has_curved_face[2] = {false, false};       ///< the facet stands for a curved surface
};

/// The features of one or several meshes in one frame, with a tree over each kind.
class VPS_API FeatureSet {
 public:
  FeatureSet();
  ~FeatureSet();
  FeatureSet(FeatureSet&&) noexcept;
  FeatureSet& operator=(FeatureSet&&) noexcept;

  /// Adds a mesh placed by X_MP; call build() afterwards. Facets without area are left out. O(n log n).
  /// @param is_sheet  its facets are met from both sides
  void append(const Mesh& mesh, const Pose& X_MP, bool is_sheet);
  /// O(n log n).
  void build();

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& facets() const { return facets_; }
  /// Outward, unit.
  [[nodiscard]] const Vec3& normal(std::uint32_t facet) const { return normals_[facet]; }
  [[nodiscard]] bool isTwoSided(std::uint32_t facet) const { return (facet_flags_[facet] & kTwoSided) != 0; }
  /// True if the facet stands for a curved surface: it is one of three or more in a row that turn by less
  /// than 8 degrees each.
  [[nodiscard]] bool isCurved(std::uint32_t facet) const { return (facet_flags_[facet] & kCurved) != 0; }
  /// The same of a triangle of a mesh, numbered as they were added; false for triangles without area.
  [[nodiscard]] bool isCurved(std::size_t mesh, std::uint32_t triangle) const {
    const std::uint32_t facet = facet_of_[first_triangle_[mesh] + triangle];
    return facet != kNone && isCurved(facet);
  }
  static constexpr std::uint32_t kNone = ~0U;
  /// The facets across the sides of a facet, from corner k to the next; kNone where there is not exactly one.
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
  /// True if the surface around the corner at a vertex lies behind the plane through it with this normal, to
  /// within a slope of a thousandth. O(log n).
  /// @param n  unit, away from the part
  [[nodiscard]] bool isOutermostAt(std::uint32_t vertex, const Vec3& n) const;
  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] double radius_m() const { return 0.5 * box_.size().norm(); }

  /// For searches of FeatureMotion.
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
  std::vector<std::uint32_t> facet_of_;      // of the triangles of all meshes
  std::vector<std::size_t> first_triangle_;  // of each mesh
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
