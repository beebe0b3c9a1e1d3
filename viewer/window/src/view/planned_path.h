// SPDX-License-Identifier: BSD-3-Clause
// The planned path of the part in hand, to be drawn.
#pragma once

#include <vector>

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct PlannedPath {
  std::vector<Vec3> points_W;  ///< of the part's centre of mass: start, way points, target; empty: no step
  Vec3 axis_W = Vec3::Zero();  ///< unit, of the last leg; zero where it has no length
};

/// @param shot  of the scene's own procedure
VPS_VIEWER_API PlannedPath plannedPath(const scenes::Scene& scene, const scenes::Snapshot& shot);

}  // namespace vps::viewer
