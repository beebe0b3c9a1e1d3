// SPDX-License-Identifier: BSD-3-Clause
// Where a head in front of a display was over time.
#pragma once

#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// Poses in the room's frame S, in order of time.
struct VPS_SCENES_API HeadTrack {
  std::vector<double> time_s;
  std::vector<Pose> X_SE;

  /// Between two poses on the straight line and the shortest turn, outside the nearest one. Not of an empty
  /// track.
  [[nodiscard]] Pose at(double t_s) const;
};

/// Reads rows of time [s], x, y, z [m] and a quaternion x, y, z, w. Throws LoadError with the line: also for
/// times that do not rise, and for four numbers that are no rotation.
VPS_SCENES_API HeadTrack loadHeadTrack(const std::string& file);

}  // namespace vps::scenes
