// SPDX-License-Identifier: BSD-3-Clause
#include "trade/excerpt.h"

#include <vector>

namespace vps::scenes {

Scene excerptOf(const Scene& scene, std::size_t step) {
  Scene excerpt = scene;
  const std::size_t moving = scene.steps[step].part;
  for (std::size_t i = 0; i < step; ++i) {
    ScenePart& mounted = excerpt.parts[scene.steps[i].part];
    mounted.is_fixed = true;
    mounted.X_WP = scene.steps[i].X_WP_target;
  }
  std::vector<ScenePart> kept;
  excerpt.steps = {scene.steps[step]};
  for (std::size_t i = 0; i < excerpt.parts.size(); ++i) {
    if (i == moving) excerpt.steps[0].part = kept.size();
    if (i == moving || excerpt.parts[i].is_fixed) kept.push_back(excerpt.parts[i]);
  }
  excerpt.parts = std::move(kept);
  excerpt.hand.seed += step;  // each step of a procedure has its own seed
  return excerpt;
}

}  // namespace vps::scenes
