// SPDX-License-Identifier: BSD-3-Clause
// The parts of an assembly, prepared and in place.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surface/part_surface.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

struct PlacedSurface {
  std::string name;
  std::shared_ptr<const PartSurface> surface;  ///< parts of equal geometry share it
  Pose X_WP;
  const DrawnPart* drawn = nullptr;  ///< for what the scene says of it
  Box box_W;                         ///< of the vertices themselves
};

/// On all cores; they point to the parts. Throws LoadError; see checkAssembly().
/// @param prepared  surfaces of earlier parts, which are taken again where the geometry is equal
std::vector<PlacedSurface> placedSurfaces(const std::vector<DrawnPart>& parts, const Progress& progress,
                                          std::span<const PlacedSurface> prepared = {});

/// The part of this name, which is among them.
const PlacedSurface& named(const std::vector<PlacedSurface>& parts, const std::string& name);

/// Pairs of parts whose boxes are nearer than near_m, in ascending order.
std::vector<std::pair<std::size_t, std::size_t>> nearPairs(const std::vector<PlacedSurface>& parts,
                                                           double near_m);

}  // namespace vps::scenes
