// SPDX-License-Identifier: BSD-3-Clause
// The border of a sheet (an open surface), and the side from which a point meets a sheet.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps::bullet {

/// Normal of a sheet at the place nearest to a point, as this point sees it.
struct SheetFoot {
  Vec3 normal = Vec3::Zero();
  bool is_rim = false;  ///< that place lies on the border, and the point lies beyond the border
};

/// The border of a sheet: edges that belong to one triangle only.
class SheetBorder {
 public:
  explicit SheetBorder(const Mesh& mesh);
  /// Normal of the sheet as seen from p, in the mesh's frame. A sheet has two sides; p is on the side that it
  /// faces, against its `inward` normal. A point beyond the border has not passed through the sheet: it meets
  /// the border as a rim, from outside.
  [[nodiscard]] SheetFoot seenFrom(const Vec3& p, const Vec3& inward,
                                   const MeshDistance::Closest& foot) const;
  /// True if a point q of a triangle lies on the border.
  [[nodiscard]] bool isOnBorder(std::uint32_t triangle, const Vec3& q) const;

 private:
  struct Edge {
    Vec3 a, b;
  };
  /// For each triangle, index of its first entry in edges_; the next triangle's index ends the range. Entries
  /// are the border edges that share a corner with the triangle.
  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;
  double touch_m_ = 0;
};

}  // namespace vps::bullet
