// SPDX-License-Identifier: BSD-3-Clause
// The cylinders of a part, from the facets of its mesh.
#pragma once

#include <vector>

#include "surface/part_surface.h"

namespace vps::scenes {

/// Facets whose corners lie on one cylinder. Corners lie on the true surface, so the radius has no error of
/// the facets' chord.
struct RoundFace {
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the part's frame
  Vec3 p = Vec3::Zero();      ///< on the axis
  double radius_m = 0;
  double from_m = 0, to_m = 0;        ///< along the axis, from p
  double residual_m = 0;              ///< greatest distance of a corner from the cylinder
  bool is_bore = false;               ///< the material is outside
  std::vector<std::uint32_t> facets;  ///< ascending
};

/// Faces that cover at least three tenths of a turn. Coarse cylinders, whose facets meet at more than
/// kCurved_rad, are prisms and are not found. O(n).
std::vector<RoundFace> roundFaces(const PartSurface& surface);

}  // namespace vps::scenes
