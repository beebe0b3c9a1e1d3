// SPDX-License-Identifier: BSD-3-Clause
// The kind of fastener that a part has the shape of.
#pragma once

#include <optional>
#include <vector>

#include "fits/fits.h"
#include "vps/errors.h"
#include "vps_scenes/fits/fasteners.h"

namespace vps::scenes {

/// The fastener that a part has the shape of, with its axis in the part's frame.
struct FastenerShape {
  FastenerKind kind = FastenerKind::Screw;
  std::string words;
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double radius_m = 0;          ///< radius of the shank, pin or hole
  double from_m = 0, to_m = 0;  ///< ends of the shank or hole, along the axis from p
};

/// The fastener that the part has the shape of; empty if there is none. O(facets).
std::optional<FastenerShape> fastenerShape(const PartSurface& surface, const FitFaces& faces);

/// The fastener shape of each part, in the order of the parts; empty for a part that is no fastener. Parts of
/// equal geometry are examined once. Runs on all cores.
std::vector<std::optional<FastenerShape>> fastenerShapes(const std::vector<PlacedSurface>& parts,
                                                         const Progress& progress);

}  // namespace vps::scenes
