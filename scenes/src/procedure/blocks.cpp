// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/blocks.h"

#include <string>

#include "vps_scenes/check.h"

namespace vps::scenes::inline v0 {

namespace {

/// True if a part is in place when a step ends: fixed, or mounted by this step or an earlier one.
bool isInPlace(const Scene& scene, const std::string& name, std::size_t step) {
  for (const ScenePart& part : scene.parts)
    if (part.part.name == name && part.is_fixed) return true;
  for (std::size_t i = 0; i <= step; ++i)
    if (scene.parts[scene.steps[i].part].part.name == name) return true;
  return false;
}

}  // namespace

std::vector<StepResult> blocksAtTargets(const Scene& scene, const Progress& progress) {
  CheckSettings settings;
  settings.has_fits = settings.has_play = false;
  const CheckResult checked = checkAssembly(scene.name, drawnParts(scene), settings, progress);
  std::vector<StepResult> blocks(scene.steps.size());
  for (std::size_t i = 0; i < scene.steps.size(); ++i) {
    const std::string& part = scene.parts[scene.steps[i].part].part.name;
    for (const CheckedPair& pair : checked.pairs) {
      if (!pair.isClash() || (pair.a != part && pair.b != part)) continue;
      const std::string& other = pair.a == part ? pair.b : pair.a;
      if (pair.interference_depth_m <= blocks[i].blocked_depth_m || !isInPlace(scene, other, i)) continue;
      blocks[i].blocked_by = other;
      blocks[i].blocked_at_W = pair.at_W;
      blocks[i].blocked_depth_m = pair.interference_depth_m;
      blocks[i].blocked_error_m = pair.error_m;
    }
  }
  return blocks;
}

}  // namespace vps::scenes::inline v0
