// SPDX-License-Identifier: BSD-3-Clause
// How deep two closed meshes overlap, by exact distance and exact crossings of edges with faces. It uses no
// voxmap and no pointshell.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mesh/box_tree.h"
#include "vps/mesh_distance.h"

namespace vps::search {

/// A closed mesh, prepared for the measurements of this header.
class ExactSolid {
 public:
  /// Copies a closed, outward mesh with shared vertices.
  explicit ExactSolid(const Mesh& mesh);
  ExactSolid(const ExactSolid&) = delete;
  ExactSolid& operator=(const ExactSolid&) = delete;

  [[nodiscard]] const Mesh& mesh() const { return surface_.mesh(); }
  [[nodiscard]] const MeshDistance& surface() const { return surface_; }
  [[nodiscard]] const Box& box() const { return box_; }
  /// Vertex pairs of all edges between faces that are not in one plane.
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& edges() const { return edges_; }
  /// Appends where segment ab crosses the surface, as fractions of the segment, not sorted. A crossing at
  /// the border of two triangles may appear twice.
  void appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const;

 private:
  MeshDistance surface_;
  Box box_;
  std::vector<Box> triangle_boxes_;
  BoxTree tree_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

struct Overlap {
  double depth_m = 0;       ///< 0 when free
  Vec3 p_W = Vec3::Zero();  ///< the deepest point found
};

/// Depths are found to within this.
inline constexpr double kCertain_m = 0.1e-6;

/// The deepest point of the edges of each solid in the other one. Surfaces that intersect do so at an edge of
/// one of them, so none is missed. Thread-safe.
Overlap deepestOverlap(const ExactSolid& a, const Pose& X_WA, const ExactSolid& b, const Pose& X_WB);

/// True if a vertex of `a`, outside `b` before and after, went through more than margin_m of b's material on
/// a straight path from one pose to the other.
/// @param X_BA_before, X_BA_after  poses of a in b
bool hasPassedThrough(const ExactSolid& a, const ExactSolid& b, const Pose& X_BA_before,
                      const Pose& X_BA_after, double margin_m);

}  // namespace vps::search
