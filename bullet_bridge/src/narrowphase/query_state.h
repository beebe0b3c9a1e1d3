// SPDX-License-Identifier: BSD-3-Clause
// What a pair keeps of one side's shell against the other's map.
#pragma once

#include <optional>

#include "vps/representative_points.h"
#include "vps_bullet/install.h"

namespace vps::bullet {

struct QueryState {
  /// O(points). The shell must outlive it.
  QueryState(const VoxMap& map, const PointShell& shell, const Settings& settings);

  QueryMemory query;  ///< for cutoffs that stay the same
  std::optional<RepresentativePoints>
      leading;  ///< of rigid contact, of a shell with more points than mayAllBeNear()
};

/// So many near points of a side or fewer are all looked at.
std::size_t mayAllBeNear(const Settings& settings);

}  // namespace vps::bullet
