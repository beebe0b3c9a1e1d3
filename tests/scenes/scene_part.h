// SPDX-License-Identifier: BSD-3-Clause
// Parts for scenes that tests put together.
#pragma once

#include <string>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// A part of the default material; its file is its name with ".stl".
inline ScenePart scenePart(const std::string& name, const Mesh& mesh, const Vec3& p_WP, bool is_fixed) {
  ScenePart out;
  out.part.name = name;
  out.part.mesh = mesh;
  out.X_WP = Pose::translation(p_WP);
  out.is_fixed = is_fixed;
  out.file = name + ".stl";
  return out;
}

}  // namespace vps::scenes
