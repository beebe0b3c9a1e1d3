// SPDX-License-Identifier: BSD-3-Clause
// Which parts are in place before a step, and where.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct PartInPlace {
  std::size_t part = 0;
  Pose X_WP;
};

/// Fixed parts, in their order; then those that later steps take off, the last of them first; then those that
/// earlier steps mounted. So the parts that two steps have in common come first, in one order.
inline std::vector<PartInPlace> partsInPlace(const Scene& scene, std::size_t before_step) {
  std::vector<PartInPlace> parts;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (scene.parts[i].is_fixed) parts.push_back({i, scene.parts[i].X_WP});
  const auto add = [&](const SceneStep& step) { parts.push_back({step.part, placeOf(step)}); };
  for (std::size_t i = scene.steps.size(); i-- > before_step + 1;)
    if (scene.steps[i].takes_off) add(scene.steps[i]);
  for (std::size_t i = 0; i < before_step; ++i)
    if (!scene.steps[i].takes_off) add(scene.steps[i]);
  return parts;
}

}  // namespace vps::scenes
