// SPDX-License-Identifier: BSD-3-Clause
// How a device smaller than a part's way carries it along: in segments, each within the workspace.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/scene.h"

namespace vps::scenes {

/// Between two segments the clutch opens, the handle goes back and takes the part anew.
///
///   way       start ----1----2---------- target       1: way point, 2: re-grasp
///   handle    |---------------|  room
///                       |---------------|
struct PathSegments {
  std::vector<Pose> way_points;           ///< X_WP: the step's own and the re-grasps, in order
  std::vector<std::size_t> index_points;  ///< which of way_points are re-grasps
  std::vector<Pose> X_DH_start;           ///< handle at each segment's start; one more than index_points
};

/// The fewest segments, each of which lies around the middle of a workspace of this size. A way that fits has
/// one. The last is as long as can be, so that where a part enters another it is in one hand. Throws
/// LoadError for a way that does not fit where the scene's device has no ratchet.
PathSegments splitPath(const Scene& scene, const SceneStep& step, const Vec3& workspace_m);

}  // namespace vps::scenes
