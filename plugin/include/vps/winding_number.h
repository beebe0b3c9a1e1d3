// SPDX-License-Identifier: BSD-3-Clause
// The generalised winding number: inside or outside of a mesh that need not be closed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// The solid angle of all triangles as seen from a point, over 4 pi: how often they wind around it. The
/// winding number is 1 inside and 0 outside of a closed mesh that faces out. Over a hole it falls smoothly
/// from 1 to 0, so that `> 0.5` defines the inside of an open mesh too. The winding number jumps by 1 across
/// a triangle and is continuous elsewhere.
///
/// Distant clusters of triangles are replaced by their first three moments, where the rest of the series is
/// provably at most `cluster_error`. Sources: Jacobson et al., Robust inside-outside segmentation using
/// generalized winding numbers, 2013; Barill et al., Fast winding numbers for soups and clouds, 2018 (in both
/// papers "far" is a ratio of lengths, here a bound of the error).
class VPS_API WindingNumber {
 public:
  /// A value and a bound of its error (clusters used times cluster_error; 100 times the error in tests).
  struct Value {
    double w = 0;
    double error = 0;
  };

  /// Copies the data that it needs. O(n log n). Triangles without area do not contribute.
  explicit WindingNumber(const Mesh& mesh, double cluster_error = 1e-2);
  /// The winding number of some of a mesh's triangles.
  WindingNumber(const Mesh& mesh, std::span<const std::uint32_t> triangles, double cluster_error = 1e-2);

  /// O(log n) typical. Thread-safe; never throws or allocates. Every thread gets the same bits.
  [[nodiscard]] Value at(const Vec3& p) const noexcept;
  /// The sum over every triangle by van Oosterom and Strackee 1983. O(n).
  [[nodiscard]] double exact(const Vec3& p) const noexcept;

 private:
  /// (c1(d) + c2(d) / R^2 + c3(d) / R^4) / R^3 at d from the centre: homogeneous polynomials of degree 1, 2,
  /// 3.
  struct Node : HierarchyNode {
    Vec3 center = Vec3::Zero();
    double accept2 = 0;  ///< beyond this squared distance from the centre the series is good enough
    std::array<double, 19> series{};
  };
  struct Moments;
  struct Turn;

  void build(std::vector<std::array<Vec3, 3>> triangles, double cluster_error);
  void expand();

  Vec3 origin_ = Vec3::Zero();
  double scale_ = 1;  ///< a power of two that scales the mesh to size 1, so that no product underflows
  double cluster_error_ = 0;
  std::vector<std::array<Vec3, 3>> corners_;  // scaled, in the order of the tree
  std::vector<Node> nodes_;
};

}  // namespace vps
