// SPDX-License-Identifier: BSD-3-Clause
// Exact distance from a point to a triangle mesh: the reference for every other distance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// Closest point q on triangle abc to p, and the feature it lies on.
/// Source: Ericson, Real-Time Collision Detection, section 5.1.5.
struct TrianglePoint {
  Vec3 q = Vec3::Zero();
  int feature = 0;  ///< 0 face; 1, 2, 3 edges ab, bc, ca; 4, 5, 6 vertices a, b, c
};
VPS_API TrianglePoint closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// A bounding-volume hierarchy over a mesh of finite vertices. Answers are exact to floating point; of
/// several triangles with the same computed distance the first counts. The sign is that of the angle-weighted
/// pseudonormal of the nearest feature, right for closed, consistently oriented meshes. Triangles without
/// area fill cracks of CAD exports and have no normal: the facets beyond them decide. Source: Baerentzen and
/// Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005.
class VPS_API MeshDistance {
 public:
  struct Closest {
    Vec3 q = Vec3::Zero();       ///< nearest point on the mesh, in the mesh's frame
    Vec3 normal = Vec3::Zero();  ///< outward unit pseudonormal of the nearest feature
    std::uint32_t triangle = 0;
    double distance_m = 0;  ///< unsigned; max_m when nothing is nearer
    bool found = false;
  };

  /// Copies the data that it needs. O(n log n). The sign requires welded vertices.
  explicit MeshDistance(const Mesh& mesh);

  /// O(log n) typical. Thread-safe, does not allocate.
  [[nodiscard]] Closest closest(const Vec3& p, double max_m = 1e300) const noexcept;
  /// Negative inside. Clamped to +-max_m; beyond max_m the sign is not computed and the answer is +max_m.
  [[nodiscard]] double signedDistance(const Vec3& p, double max_m = 1e300) const noexcept;
  /// A lower bound L of the unsigned distance with L <= distance <= L (1 + slack); faster than closest()
  /// where many triangles are about equally far. If nothing is nearer than max_m: max_m / (1 + slack).
  [[nodiscard]] double lowerBound(const Vec3& p, double slack, double max_m = 1e300) const noexcept;
  /// Outward unit pseudonormal of a triangle's feature (numbered as in TrianglePoint).
  [[nodiscard]] Vec3 featureNormal(std::uint32_t triangle, int feature) const noexcept;

  /// Outward unit normal, at point q of a triangle, of the curved surface that the facets approximate. The
  /// normal is interpolated between the normals of the triangle's corners (Phong 1975). A corner's normal is
  /// the mean of the faces around it that are within 20 degrees of this triangle. On a flat face the result
  /// is the face's normal.
  [[nodiscard]] Vec3 smoothNormal(std::uint32_t triangle, const Vec3& q) const noexcept;
  /// Derivative S of smoothNormal() along a triangle [1/m]: dn = S dx, symmetric, zero across the triangle. A
  /// ball of radius r has curvature 1/r in both directions, a hollow of radius r has -1/r. Zero for a flat
  /// face and for a triangle without area.
  [[nodiscard]] Mat3 smoothCurvature(std::uint32_t triangle) const noexcept;

  /// Writes up to `most` triangles whose bounding boxes may overlap `box`, in no particular order; returns
  /// false if there are more. The bounding boxes are in single precision, rounded outwards.
  bool overlapping(const Box& box, std::size_t most, std::vector<std::uint32_t>& triangles) const;

  /// Appends the places where segment ab crosses the triangles, as fractions of the segment, not sorted. A
  /// crossing at the border of two triangles may appear twice. A triangle in whose plane the segment lies is
  /// not crossed, up to rounding; an end of the segment in the plane counts as below it. O(log n + triangles
  /// whose boxes the segment meets).
  void appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const;

  [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }

 private:
  void computeNormals();
  void computeSmoothCorners();
  void buildTree();
  [[nodiscard]] bool isNextToThin(std::uint32_t triangle, int feature) const noexcept;
  [[nodiscard]] Vec3 normalThrough(const Vec3& q) const noexcept;
  template <typename Visit>
  double search(const Vec3& p, double max_m, double box_weight, Visit onNearer) const noexcept;

  static constexpr int kLanes = 8;
  using Lanes = Eigen::Array<float, kLanes, 1>;
  using IsLane = Eigen::Array<bool, kLanes, 1>;
  /// Eight boxes in one node, in floats about the mesh's centre, rounded outwards; unused lanes are
  /// infinitely far. The members are plain arrays, since a program that includes this header may be compiled
  /// for wider vectors.
  struct Node {
    Node();
    void set(int lane, const Vec3& min_m, const Vec3& max_m, std::uint32_t to);
    [[nodiscard]] Lanes distance2(const Eigen::Vector3f& p) const;
    [[nodiscard]] IsLane overlaps(const Eigen::Vector3f& low, const Eigen::Vector3f& high) const;
    [[nodiscard]] IsLane meets(const Eigen::Vector3f& middle, const Eigen::Vector3f& half) const;
    [[nodiscard]] Lanes lowest(int axis) const { return Eigen::Map<const Lanes>(min[axis]); }
    [[nodiscard]] Lanes highest(int axis) const { return Eigen::Map<const Lanes>(max[axis]); }
    float min[3][kLanes], max[3][kLanes];
    std::uint32_t child[kLanes] = {};  ///< a node, or a triangle and kTriangle
  };
  static constexpr std::uint32_t kTriangle = 1U << 31;
  /// Number of upper levels of the tree. A node of one of these levels divides its triangles by the surface
  /// area heuristic, which may split off only a few triangles. A node of a lower level divides its triangles
  /// at medians, so that each of its eight children has an eighth of them, up to a difference of eight
  /// triangles.
  static constexpr int kLevelsByArea = 20;
  /// Greatest number of levels of the tree: kLevelsByArea; ten levels that divide at medians, enough for 2^28
  /// groups of eight triangles; and one level whose children are triangles.
  static constexpr int kMostLevels = kLevelsByArea + 11;

  Mesh mesh_;
  Vec3 center_ = Vec3::Zero();
  std::vector<Node> nodes_;
  std::vector<Vec3> face_normals_;
  std::vector<std::array<Vec3, 3>> edge_normals_;
  std::vector<Vec3> vertex_normals_;
  std::vector<std::array<Eigen::Vector3f, 3>> smooth_corners_;  // by triangle; floats to save memory
  double touch_m_ = 0;                                          // distances below this count as contact
  std::vector<std::uint8_t> is_thin_;                           // by triangle: too thin to have a normal
  std::vector<std::uint8_t> is_edge_of_thin_;                   // by triangle, a bit for each edge
  std::vector<std::uint8_t> is_corner_of_thin_;                 // by vertex
};

}  // namespace vps
