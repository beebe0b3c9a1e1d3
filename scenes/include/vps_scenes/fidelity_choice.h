// SPDX-License-Identifier: BSD-3-Clause
// Picks a fidelity for a scene by building and counting, never by the clock.
#pragma once

#include <optional>
#include <string>

#include "vps/fidelity.h"
#include "vps/progress.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

struct Scene;

/// What a scene should come to; what is not set does not matter.
struct FidelityWish {
  std::optional<double> budget_hz;    ///< physics steps a second
  std::optional<double> tolerance_m;  ///< greatest error of depth at 95 of 100 points of every surface
  std::optional<double> memory_bytes;
  /// What building may take without being wished for; 0: half of what this machine has. Changes no choice:
  /// beyond it there is none.
  double machine_bytes = 0;
};

/// Cost of a physics step [us] by the points that may be near contact in it: of the part in hand, and of as
/// much of the others as it can cover. Fitted once to the 99th percentile of processor time in `vps trade
/// scenes/peg_in_hole/scene.toml` (a shared 2-core Xeon): what a budget_hz means on another machine, vps
/// trade measures there. A count, so that a choice is the same everywhere.
inline constexpr double kStepBase_us = 400, kStepPoint_us = 0.055;

struct FidelityChoice {
  Fidelity fidelity;
  bool is_met = false;
  std::string failure_reason;  ///< empty when met: which wish nobody can meet, and what would help
  double error_m = 0;          ///< as FidelityWish::tolerance_m, measured
  std::size_t points = 0, points_near = 0, bytes = 0;  ///< as built; bytes with the cooked field
  double step_us = 0;                                  ///< by the cost model
};

/// The coarsest voxel that keeps the tolerance (measured against the exact surfaces at seeded points), points
/// at twice its size; then, for the budget and the memory, fewer points first (spacing up to four times, a
/// sixteenth of the points); then, where there is no tolerance, one side for the budget and larger voxels for
/// the memory. Starts from the scene's own fidelity, and leaves the scene's parts with the models of the
/// choice, if it is met. Deterministic: same scene, same choice, on every machine. Seconds for a scene of ten
/// parts. Throws LoadError for a part that cannot be modelled.
VPS_SCENES_API FidelityChoice chooseFidelity(Scene& scene, const FidelityWish& wish,
                                             const Progress& progress = {});

/// The choice as lines of a scene file, to paste.
VPS_SCENES_API std::string toToml(const Fidelity& fidelity);

/// "voxel 0.18 mm, spacing 0.35 mm, both sides: depth to 0.9 um, 12,345 points, 8.1 MB, a step of ..."
VPS_SCENES_API std::string describe(const FidelityChoice& choice);

}  // namespace vps::scenes
