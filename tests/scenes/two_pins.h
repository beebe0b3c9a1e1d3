// SPDX-License-Identifier: BSD-3-Clause
// A scene of two steps that runs in a few seconds of wall-clock time.
#pragma once

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Two pins that are set down next to each other on a plate. The run has a change of parts, and a fixed field
/// that is built while the loop runs.
inline Scene twoPins() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(3);
  scene.parts[0].part = {"plate", makeBox({20e-3, 10e-3, 2e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.steps.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    scene.parts[i + 1].part = {i == 0 ? "left" : "right", makeBox({2e-3, 2e-3, 2e-3}), {}, {}};
    const double x_m = i == 0 ? -5e-3 : 5e-3;
    scene.steps[i].part = i + 1;
    scene.steps[i].X_WP_target = Pose::translation({x_m, 0, 2e-3});
    scene.steps[i].tolerance_m = 0.5e-3;  // no fit guides the pin sideways: the tolerance of placement by eye
    scene.steps[i].X_WP_start = Pose::translation({x_m, 0, 2.2e-3});
  }
  scene.fidelity.haptic_rate_hz = 500;
  scene.fidelity.physics_rate_hz = 200;  // no divisor of 500: the threads exchange state at irregular phases
  scene.release_s = 0.1;
  scene.hand.aim_error_m = 0.05e-3;
  return scene;
}

}  // namespace vps::scenes
