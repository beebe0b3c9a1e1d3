// SPDX-License-Identifier: BSD-3-Clause
// The features of a mesh: faces, edges and vertices with their neighbours. The part of space that is nearest
// to a feature has a simple description.
//
// The point q of a surface that is nearest to p lies within a face, within an edge, or at a vertex. Then
//   face:   p lies above or below the triangle, within its three sides;
//   edge:   p lies between the edge's two ends, and beyond the edge from every face that meets there;
//   vertex: p lies beyond the vertex along every edge that meets there.
// Every point is therefore in the region of its own nearest feature, for any mesh, closed or not, with any
// number of faces at an edge. Where the surface is smooth the regions of edges and vertices are thin.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// Side `side` of a triangle, from its corner `side` to the next.
struct TriangleSide {
  std::uint32_t triangle : 30;
  std::uint32_t side : 2;
};

class SurfaceFeatures {
 public:
  struct Edge {
    std::uint32_t a, b;   ///< vertices, a < b
    std::uint32_t first;  ///< index of the first of the edge's sides
  };

  /// A point within this distance of a corner or a side lies on it [voxels].
  static constexpr double kTouch = 1e-6;

  /// Converts positions to voxels: p / voxel_m - origin. Expects welded vertices and at most 2^30 triangles.
  /// O(n).
  SurfaceFeatures(const Mesh& mesh, double voxel_m, const Vec3& origin);

  [[nodiscard]] std::uint32_t faceCount() const { return static_cast<std::uint32_t>(triangles_.size()); }
  [[nodiscard]] std::uint32_t edgeCount() const { return static_cast<std::uint32_t>(edges_.size() - 1); }
  [[nodiscard]] std::uint32_t vertexCount() const { return static_cast<std::uint32_t>(points_.size()); }

  [[nodiscard]] const Vec3& point(std::uint32_t vertex) const { return points_[vertex]; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& triangle(std::uint32_t i) const { return triangles_[i]; }
  /// Unit outward normal; zero for a triangle too thin to have one, which its edges then replace.
  [[nodiscard]] const Vec3& normal(std::uint32_t triangle) const { return normals_[triangle]; }
  [[nodiscard]] const Edge& edge(std::uint32_t i) const { return edges_[i]; }
  /// The sides that make up an edge.
  [[nodiscard]] std::span<const TriangleSide> sidesOf(std::uint32_t edge) const {
    return std::span(sides_).subspan(edges_[edge].first, edges_[edge + 1].first - edges_[edge].first);
  }
  /// The sides that begin at a vertex, one for each triangle at the vertex.
  [[nodiscard]] std::span<const TriangleSide> sidesFrom(std::uint32_t vertex) const {
    return std::span(corners_).subspan(first_corner_[vertex],
                                       first_corner_[vertex + 1] - first_corner_[vertex]);
  }
  /// True if every edge at the vertex has two triangles that agree on orientation.
  [[nodiscard]] bool isRegular(std::uint32_t vertex) const { return is_regular_[vertex] != 0; }
  /// Sum of the normals at a vertex, weighted by angle. Source: Baerentzen and Aanaes 2005.
  [[nodiscard]] Vec3 pseudonormal(std::uint32_t vertex) const;
  /// The pseudonormal at a point q of the surface, from the triangles `around` it and from triangles that
  /// touch q behind triangles without a normal: a collinear triangle that closes a T-junction hides the face
  /// to which it belongs. Slower than pseudonormal().
  [[nodiscard]] Vec3 pseudonormalThrough(const Vec3& q, std::span<const TriangleSide> around) const;
  /// True if one of the triangles has no normal.
  [[nodiscard]] bool hasThin(std::span<const TriangleSide> sides) const;

 private:
  void computeNormals();
  void collectCorners();
  void collectEdges();
  void nameSides();
  [[nodiscard]] double angleAt(const Vec3& q, std::uint32_t triangle) const;

  const std::vector<std::array<std::uint32_t, 3>>& triangles_;  // of the mesh
  std::vector<Vec3> points_, normals_;
  std::vector<std::uint32_t> first_corner_;
  std::vector<TriangleSide> corners_;
  std::vector<Edge> edges_;  // with one more entry for the end
  std::vector<TriangleSide> sides_;
  std::vector<std::uint8_t> is_regular_;
  bool has_thin_ = false;
  std::vector<std::uint32_t> edge_of_;  // by 3 triangle + side; empty unless a triangle is thin
};

}  // namespace vps
