// SPDX-License-Identifier: BSD-3-Clause
// A simulation of small parts in larger lengths.
#pragma once

#include "vps_scenes/run/simulate.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Contact has lengths and speeds of its own (a rest gap of 0.1 um, a margin of 20 um, ...: vps_bullet),
/// which are right for parts of millimetres and more. A scene whose smallest moving part is less than
/// kLeastAcross_m across is therefore simulated in lengths that are larger by this factor, a power of two, so
/// that nothing is rounded; times stay. 1 for all other scenes.
inline constexpr double kLeastAcross_m = 1e-3;
double simulationScale(const Scene& scene);

/// The similar scene: all lengths, velocities and gravity times `factor`. Densities stay, so that masses go
/// with its cube. Without models.
Scene scaledScene(const Scene& scene, double factor);

/// What a simulation of the similar scene says about the scene.
SimulateResult scaledBack(SimulateResult result, double factor);
std::vector<BodyState> scaledBack(std::vector<BodyState> bodies, double factor);

}  // namespace vps::scenes
