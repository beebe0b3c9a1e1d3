// SPDX-License-Identifier: BSD-3-Clause
// The inside of a mesh that is not closed, or that overlaps itself, and the facets at which pseudonormals
// tell the same inside. Solid and the voxeliser both use it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps/mesh_distance.h"
#include "vps/winding_number.h"

namespace vps {

/// A bound of the gradient of the winding number away from triangles. The gradient is the field of a current
/// along the mesh's border (Biot and Savart), so it is at most the sum of length / distance^2 over border
/// edges, over 4 pi; zero for a closed mesh. An edge belongs to the border unless it has as many facets in
/// one direction as in the other.
class WindingSlope {
 public:
  explicit WindingSlope(const Mesh& mesh);
  [[nodiscard]] bool isZero() const noexcept { return nodes_.empty(); }
  /// A bound [1/m] of the gradient's length anywhere in the box; infinite where the border enters it.
  [[nodiscard]] double bound(const Box& box) const noexcept;

 private:
  struct Node : HierarchyNode {
    Box box;
    double length_m = 0;
  };
  std::vector<Node> nodes_;
  std::vector<std::pair<Box, double>> edges_;  // box and length [m]
};

/// A point is inside if its winding number exceeds 0.5 and it lies within the box of the surface. The box is
/// needed because walls that face the wrong way raise the winding number above 0.5 far from the part.
class Interior {
 public:
  /// Several times the error of WindingNumber::at(), as tests measure it. A winding number that is nearer to
  /// 0.5 than this proves nothing.
  static constexpr double kDoubt = 0.02;

  /// @param solid  RepairedMesh::solid: facets face out, vertices are shared
  /// @param box    of RepairedMesh::surface
  Interior(Mesh solid, const Box& box) : mesh_(std::move(solid)), box_(box), winding_(mesh_), slope_(mesh_) {}

  [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const Box& box() const noexcept { return box_; }
  /// The gradient away from facets is bounded by slope().
  [[nodiscard]] double windingNumber(const Vec3& p) const noexcept { return winding_.at(p).w; }
  [[nodiscard]] const WindingSlope& slope() const noexcept { return slope_; }
  [[nodiscard]] bool mayHold(const Vec3& p) const noexcept {
    return (p.array() > box_.min.array()).all() && (p.array() < box_.max.array()).all();
  }
  [[nodiscard]] bool isInside(const Vec3& p) const noexcept { return mayHold(p) && windingNumber(p) > 0.5; }

 private:
  Mesh mesh_;
  Box box_;
  WindingNumber winding_;
  WindingSlope slope_;
};

/// Unknown: too many other facets are near.
enum class Crossed : std::uint8_t { No, Yes, Unknown };

/// For each of the first `count` triangles of a mesh: whether another triangle crosses it, or touches it
/// elsewhere than at a common vertex. Triangles that share an edge count only if one lies on the other;
/// copies of a triangle do not count as crossing. Expects shared vertices. Parallel; O(n log n) for usual
/// meshes.
std::vector<Crossed> crossedFacets(const MeshDistance& all, std::size_t count);

/// A flag for each vertex: every edge at it has two triangles that agree on orientation, and its triangles
/// form one fan. At such a vertex pseudonormals distinguish the two sides of the surface. O(n log n).
std::vector<std::uint8_t> regularVertices(const Mesh& mesh);

/// For each triangle of `surface` a distance up to which the pseudonormal at a nearest point on the triangle
/// gives the same side as the winding number; 0 if no such distance is known. A distance is known if
/// - all vertices of the triangle are regular, and no triangle crosses it, so that the surface there has two
///   sides;
/// - the winding number is below 0.5 in front of the triangle and above 0.5 behind it;
/// - the winding number's slope is too small to carry it past 0.5 within that distance.
/// Two winding numbers for each triangle; parallel.
std::vector<float> sureDistances(const MeshDistance& surface, const Interior& interior);

}  // namespace vps
