// SPDX-License-Identifier: BSD-3-Clause
// Load shedding: what a run in real time reduces when it cannot hold its physics rate, and in which order.
#pragma once

#include <array>
#include <string>

#include "vps/fidelity.h"
#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

/// A load level relative to the scene's own settings. Force limits, passivity control and watchdogs are the
/// same at every level.
struct LoadLevel {
  double spacing_factor = 1;  ///< spacing of the points relative to the scene's, >= 1
  int rate_divisor = 1;       ///< the physics rate is divided by this number
  int time_divisor = 1;       ///< simulated time runs at 1/time_divisor of real time

  /// Wall-clock duration of one step, in physics periods of the scene.
  [[nodiscard]] int periods() const noexcept { return rate_divisor * time_divisor; }
};

/// The levels in order: fewer points first, then fewer steps, then slower time; each level keeps the
/// reductions of the level before. The spacing only doubles, since a scene that states no spacing already has
/// the widest one that its parts allow. assumed: below a quarter of the rate and of the speed of time, the
/// task would no longer be the same.
inline constexpr std::array<LoadLevel, 6> kLoadLevels = {
    {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {2, 4, 1}, {2, 4, 2}, {2, 4, 4}}};

/// Bound of the load (duration of a step by its period) at level - 1, divided by the load at `level`. The
/// number of points is proportional to the inverse square of their spacing. @param level  1 to 5
VPS_SCENES_API double costRatio(std::size_t level);

/// The level in words, for example "points every 1 mm, physics at 500 Hz, time at 1/2 of the clock's".
VPS_SCENES_API std::string describe(const LoadLevel& level, const Fidelity& fidelity);

/// The error that a change of level causes, in words: the bound that is known in advance, and the measured
/// difference.
VPS_SCENES_API std::string describeCost(const LoadLevelChange& change);

}  // namespace vps::scenes
