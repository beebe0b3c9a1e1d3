// SPDX-License-Identifier: BSD-3-Clause
// Splits a path that is longer, or turns farther, than the device's workspace into segments that fit. Between
// two segments the device is clutched and recentred (indexing).
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The segments of a step's path. An index point is a pose of the path at which one segment ends and the
/// next begins: there the device is clutched and recentred.
///
///   path      start ----1----2---------- target       1: way point of the step, 2: index point
///   handle    |--------------|
///                            |---------------|         each segment fits into the workspace
struct PathSegments {
  std::vector<Pose> way_points;  ///< X_WP of the part: the step's way points and the index points, in order
  std::vector<std::size_t> index_points;  ///< indices of the way points that are index points
  std::vector<Pose> X_DH_start;  ///< pose of the handle at each segment's start; one more than index_points
};

/// Positions and rotations that a device's handle can reach.
struct Workspace {
  Vec3 size_m = Vec3::Zero();  ///< size of the box of positions
  double turn_rad = 0;         ///< greatest rotation from the identity, about any axis; 0: no limit
};

/// The fewest segments, each centred in the workspace in position and rotation. A path that fits into the
/// workspace has one segment. The last segment is as long as possible, so that a part is not re-grasped while
/// it enters another. Throws LoadError for a path that does not fit if the scene's device has no indexing,
/// and for two poses half a turn apart, since the direction in which the hand turns is then not defined.
PathSegments splitPath(const Scene& scene, const SceneStep& step, const Workspace& workspace);

/// The segments that remain after the part has passed `passed` of the step's own way points.
PathSegments withoutPassed(const PathSegments& segments, std::size_t passed);

/// Rotation after which a handle that turns by handle_rad to each side is grasped again.
double turnRange_rad(double handle_rad);

}  // namespace vps::scenes
