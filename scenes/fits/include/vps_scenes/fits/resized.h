// SPDX-License-Identifier: BSD-3-Clause
// A cylinder of a part that is made thinner or wider: the shank of a screw that is drawn as wide as its
// thread.
#pragma once

#include "vps/mesh.h"
#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

/// A cylinder of a part that is made thinner or wider, in the part's frame P.
struct Resized {
  Vec3 axis = Vec3::UnitZ(), p = Vec3::Zero();
  double from_m = 0, to_m = 0;  ///< extent along the axis, measured from p
  double from_radius_m = 0, to_radius_m = 0;
};

/// Moves the vertices of a cylinder, and of chamfers at its ends, to the new radius if they lie outside it
/// (for a hole: inside it). O(vertices).
VPS_SCENES_API void resize(Mesh& mesh, const Resized& to);

}  // namespace vps::scenes
