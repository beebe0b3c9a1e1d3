// SPDX-License-Identifier: BSD-3-Clause
// What is inside of a mesh that is not closed, or that overlaps itself. Solid and the voxeliser both use it.
#pragma once

#include <utility>

#include "mesh/winding_slope.h"
#include "vps/mesh.h"
#include "vps/winding_number.h"

namespace vps {

/// Inside is where the winding number exceeds 0.5, within the box of the surface. Beyond that box nothing is
/// inside, whatever the winding number: walls that face the wrong way raise it above 0.5 far from the part.
class Interior {
 public:
  /// Several times the error of WindingNumber::at(), as tests measure it. Nothing is concluded from a winding
  /// number that is nearer to 0.5 than this.
  static constexpr double kDoubt = 0.02;

  /// @param solid  RepairedMesh::solid: facets face out, vertices are shared
  /// @param box    of RepairedMesh::surface
  Interior(Mesh solid, const Box& box) : mesh_(std::move(solid)), box_(box), winding_(mesh_), slope_(mesh_) {}

  [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const Box& box() const noexcept { return box_; }
  /// Its gradient, away from facets, is at most slope().
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
