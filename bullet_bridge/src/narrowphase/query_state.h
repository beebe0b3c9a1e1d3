// SPDX-License-Identifier: BSD-3-Clause
// What a pair stores from step to step for the points of one side in the other's map.
#pragma once

#include <optional>

#include "vps/representative_points.h"
#include "vps_bullet/settings.h"

namespace vps::bullet::inline v0 {

struct QueryState {
  /// O(points). The shell must outlive it.
  QueryState(const VoxMap& map, const PointShell& shell, const Settings& settings);

  QueryMemory query;  ///< valid for one cutoff
  /// One representative point per surface tile; for constraint contact and shells with more points than
  /// smallQueryLimit().
  std::optional<RepresentativePoints> leading;
};

/// Up to this number of near points of one side, all of them are examined.
std::size_t smallQueryLimit(const Settings& settings);

}  // namespace vps::bullet::inline v0
