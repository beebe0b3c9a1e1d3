// SPDX-License-Identifier: BSD-3-Clause
#include "scene/screw_keys.h"

#include <algorithm>

namespace vps::scenes::inline v0 {

void requireScrew(const SceneKeys& keys, const SceneStep& step) {
  constexpr double kTurned_rad = 1e-6;  // beyond rounding of the file's numbers
  if (step.motion != StepMotion::Screw) {
    for (const char* key : {"pitch", "torque_Nm"})
      if (keys.has(key)) keys.fail(key, "is of a screw; say motion = \"screw\" as well, or leave it out");
    return;
  }
  if (step.pitch_m == 0)
    keys.fail("motion",
              "is a screw, whose 'pitch' is not found in the mesh; give it, negative for a left-hand "
              "thread");
  const auto turns = [&](const Pose& X_WP) {
    return rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm() > kTurned_rad;
  };
  if (turns(step.X_WP_start) || std::any_of(step.way_points.begin(), step.way_points.end(), turns))
    keys.fail("motion",
              "is a screw, but the path turns it; give start and way points the rotation of the "
              "target, since the hand turns it by itself");
}

}  // namespace vps::scenes::inline v0
