// SPDX-License-Identifier: BSD-3-Clause
// Simulation of small parts with scaled lengths.
#pragma once

#include "vps_scenes/run/simulate.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Factor by which lengths are scaled. Contact has constant lengths and speeds (a rest gap of 0.1 um, a
/// margin of 20 um, ...: vps_bullet), which suit parts of millimetres and more. A scene whose smallest moving
/// part is less than kLeastAcross_m across is therefore simulated with scaled lengths; times are unchanged.
/// The factor is a power of two, so that scaling rounds no number, and 1 for all other scenes.
inline constexpr double kLeastAcross_m = 1e-3;
double simulationScale(const Scene& scene);

/// The similar scene: all lengths, velocities and gravity times `factor`. Densities are unchanged, so that
/// masses scale with the cube of `factor`. The scene has no models.
Scene scaledScene(const Scene& scene, double factor);

/// Converts results of the scaled scene to the scene's own lengths.
SimulateResult scaledBack(SimulateResult result, double factor);
std::vector<BodyState> scaledBack(std::vector<BodyState> bodies, double factor);

}  // namespace vps::scenes
