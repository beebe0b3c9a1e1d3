// SPDX-License-Identifier: BSD-3-Clause
// Where the parts of a fixed field lie before anything has run.
#pragma once

#include <algorithm>
#include <vector>

#include "models/fixed_field.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The poses at which the parts are cooked: fixed parts as designed, others where their steps have them in
/// place.
class CookedPoses {
 public:
  explicit CookedPoses(const Scene& scene) {
    for (const ScenePart& part : scene.parts) X_WP_.push_back(part.X_WP);
    for (const SceneStep& step : scene.steps) X_WP_[step.part] = placeOf(step);
  }
  /// The parts of the field in place, followed by those that the step adds.
  [[nodiscard]] std::vector<FixedPart> add(std::vector<FixedPart> parts, const FieldPlan& step) const {
    for (const std::size_t i : step.cooked)
      if (std::ranges::none_of(parts, [i](const FixedPart& placed) { return placed.part == i; }))
        parts.push_back({i, X_WP_[i]});
    return parts;
  }

 private:
  std::vector<Pose> X_WP_;
};

}  // namespace vps::scenes
