// SPDX-License-Identifier: BSD-3-Clause
// What a pair stores from step to step for the points of one side in the other's map.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "vps/representative_points.h"
#include "vps_bullet/settings.h"

namespace vps::bullet {

struct QueryState {
  /// O(points / 16). The shell must outlive it.
  QueryState(const VoxMap& map, const PointShell& shell) : query(map, shell) {}

  QueryMemory query;
  /// Two representative points of each group of neighbours with similar normals; for constraint contact, as
  /// soon as more points than smallQueryLimit() have been near. O(points) to make: most pairs never need it.
  std::optional<RepresentativePoints> leading;
  /// @param radius_m  of the pair's smaller body
  void lead(const PointShell& shell, std::span<const std::uint8_t> on_edge, double radius_m);
};

/// Up to this number of near points of one side, all of them are examined.
std::size_t smallQueryLimit(const Settings& settings);
/// About this number of candidates is refined by the exact surfaces: enough although some turn out to be out
/// of reach. With half of it a shaft in its bushings had to be solved again in most steps, which cost more.
std::size_t refinedLimit(const Settings& settings);
/// True if representative points serve for so many near points.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings);

}  // namespace vps::bullet
