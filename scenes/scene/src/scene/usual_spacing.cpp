// SPDX-License-Identifier: BSD-3-Clause
#include "scene/usual_spacing.h"

#include <algorithm>
#include <limits>

#include "vps/box.h"

namespace vps::scenes {

SmallestPart smallestMoved(const Scene& scene) {
  SmallestPart out{"", std::numeric_limits<double>::infinity()};
  const auto add = [&](const Part& part) {
    const double across_m = bounds(part.mesh).size().minCoeff();
    if (across_m < out.across_m) out = {part.name, across_m};
  };
  for (const SceneStep& step : scene.steps) add(scene.parts[step.part].part);
  if (scene.steps.empty())
    for (const ScenePart& part : scene.parts)
      if (!part.is_fixed) add(part.part);
  return out;
}

double usualSpacing_m(const Scene& scene) {
  const double voxel_m = scene.fidelity.voxel_m;
  if (scene.fidelity.contact_method == ContactMethod::Penalty) return 2 * voxel_m;
  constexpr double kShare = 0.25;
  return std::clamp(kShare * smallestMoved(scene).across_m, 2 * voxel_m, 4 * voxel_m);
}

}  // namespace vps::scenes
