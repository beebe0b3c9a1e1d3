// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a surface, and the exact distances that close them.
#pragma once

#include "field_error.h"

namespace vps::bench {

/// A point of one part in the field of the other.
struct Reading {
  Vec3 p, inward;                                   ///< in its own part
  double reading_m = 0, distance_m = 0;             ///< of the field, and exactly
  std::array<double, kBounds.size()> bound_m = {};  ///< of their difference, by Bound
  bool is_beside_edge = false;
  [[nodiscard]] double least_m(Bound bound) const {
    return reading_m - bound_m[static_cast<std::size_t>(bound)];
  }
};

struct Count {
  double tiles = 0, exact = 0, beside_edges = 0, broken = 0;
  double most = 0;  ///< exact distances in a tile
  void add(const Count& other);
};

/// The points of a part in the field of another, nearer than near_m.
std::vector<Reading> readPoints(const PartModel& points_of, const PartModel& in, FieldError& error,
                                const Pose& X_MP, double near_m);

/// How many exact distances close all tiles: in each tile points are measured in the order of their lower
/// bounds, until the least distance is no greater than the bounds that are left, or these are above reach_m.
/// `broken` counts distances below their bounds.
/// @param tile_m  points are in one tile if they are in one cell of this size and their normals in one of 24
///                directions
Count closeTiles(const std::vector<Reading>& readings, double tile_m, Bound bound, double reach_m);

}  // namespace vps::bench
