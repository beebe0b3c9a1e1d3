// SPDX-License-Identifier: BSD-3-Clause
// The inside of a mesh that is not closed, or that overlaps itself. Solid and the voxeliser both use it.
#pragma once

#include <utility>

#include "mesh/winding_slope.h"
#include "vps/mesh.h"
#include "vps/winding_number.h"

namespace vps {

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

}  // namespace vps
