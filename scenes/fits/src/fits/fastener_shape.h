// SPDX-License-Identifier: BSD-3-Clause
// What kind of fastener a part has the shape of.
#pragma once

#include <optional>
#include <vector>

#include "fits/fits.h"
#include "vps/errors.h"
#include "vps_scenes/fits/fasteners.h"

namespace vps::scenes {

/// In the part's frame.
struct FastenerShape {
  FastenerKind kind = FastenerKind::Screw;
  std::string words;
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double radius_m = 0;          ///< of shank, pin or hole
  double from_m = 0, to_m = 0;  ///< of the shank or the hole, along the axis from p
};

/// Empty for a part that has the shape of none. O(facets).
std::optional<FastenerShape> fastenerShape(const PartSurface& surface, const FitFaces& faces);

/// Those of all parts, each shape told once; empty where a part is none. On all cores.
std::vector<std::optional<FastenerShape>> fastenerShapes(const std::vector<PlacedSurface>& parts,
                                                         const Progress& progress);

}  // namespace vps::scenes
