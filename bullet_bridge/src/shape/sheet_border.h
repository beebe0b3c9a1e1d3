// SPDX-License-Identifier: BSD-3-Clause
// The border of an open surface, and the side from which a point meets such a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps/mesh_distance.h"

namespace vps::bullet {

/// Outward normal at a point's foot on a sheet, for that point.
struct SheetFoot {
  Vec3 normal = Vec3::Zero();
  bool is_rim = false;  ///< the foot is on the border, and the point lies outside it
};

/// The border of a sheet: the edges that belong to one triangle only.
class SheetBorder {
 public:
  explicit SheetBorder(const Mesh& mesh);
  /// A sheet has two sides; the point comes from the one that it faces, against its `inward` normal. A point
  /// outside the border has not passed through the sheet: the border acts as a rim, met from outside. All in
  /// the mesh's frame.
  [[nodiscard]] SheetFoot seenFrom(const Vec3& p, const Vec3& inward,
                                   const MeshDistance::Closest& foot) const;
  /// True if a point q of a triangle lies on the border.
  [[nodiscard]] bool isOnBorder(std::uint32_t triangle, const Vec3& q) const;

 private:
  struct Edge {
    Vec3 a, b;
  };
  /// By triangle: index of its first entry in edges_, followed by that of the next triangle. Entries are the
  /// border's edges that share a corner with the triangle.
  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;
  double touch_m_ = 0;
};

}  // namespace vps::bullet
