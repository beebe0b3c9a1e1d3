// SPDX-License-Identifier: BSD-3-Clause
// Two views of the procedure: the exploded assembly, and the planned path of the part in hand.
#pragma once

#include <vector>

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// The exploded view: each part that a step mounts is moved back along the last leg of its path, farther for
/// later steps. Contacts and target are removed. A share of 0 changes nothing.
/// @param share   distance of the last step's part, as a share of size_m
/// @param size_m  size of the assembly
[[nodiscard]] VPS_VIEWER_API scenes::Snapshot exploded(const scenes::Scene& scene, scenes::Snapshot snapshot,
                                                       double share, double size_m);

struct PlannedPath {
  /// Path of the part's centre of mass: start, way points, target; empty: no step.
  std::vector<Vec3> points_W;
  Vec3 axis_W = Vec3::Zero();  ///< direction of the last leg, a unit vector; zero if the leg has no length
};

/// The planned path of the snapshot's step.
/// @param shot  snapshot of the scene's own procedure
VPS_VIEWER_API PlannedPath plannedPath(const scenes::Scene& scene, const scenes::Snapshot& shot);

}  // namespace vps::viewer
