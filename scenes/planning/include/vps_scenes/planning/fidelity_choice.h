// SPDX-License-Identifier: BSD-3-Clause
// Chooses a fidelity for a scene by building models and counting, never by the clock.
#pragma once

#include <string>

#include "vps/errors.h"
#include "vps_scenes/export.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Cost model of a physics step [us]: a constant, and a term for each point that may be near contact in it
/// (those of the part in hand, and as many of the others as it can cover). Fitted once to the 99th percentile
/// of processor time in `vps trade scenes/peg_in_hole/scene.toml` on a shared 2-core Xeon; on another machine
/// `vps trade` measures what a rate needs. A count, so that a choice is the same everywhere.
inline constexpr double kStepBase_us = 400, kStepPoint_us = 0.055;

struct FidelityChoice {
  Fidelity fidelity;
  bool is_met = false;
  std::string failure_reason;  ///< which bound cannot be kept, and the remedy; empty when all are kept
  double error_m = 0;          ///< as FidelityWish::tolerance_m, measured
  std::size_t points = 0, points_near = 0, bytes = 0;  ///< as built; bytes with the cooked field
  double step_us = 0;                                  ///< by the cost model
};

struct ChoiceOptions {
  Progress progress;
  /// Memory that models may take while they are built; 0: half of this machine's. It never changes a choice:
  /// where more would be needed there is none.
  double machine_bytes = 0;
};

/// Finds the coarsest voxel that keeps the tolerance (measured against the exact surfaces at seeded points),
/// with points at twice its size. For the rate and the memory it then takes fewer points (up to four times
/// the spacing, a sixteenth of the points); then, where there is no tolerance, one side for the rate and
/// larger voxels for the memory. Starts from the scene's own fidelity. If the wish is met, the scene's parts
/// keep the models of the choice. Deterministic: the same scene gives the same choice on every machine. Takes
/// seconds for a scene of ten parts. Throws LoadError for a part that cannot be modelled.
VPS_SCENES_API FidelityChoice chooseFidelity(Scene& scene, FidelityWish wish,
                                             const ChoiceOptions& options = {});

/// Chooses the fidelity of a scene whose file says `auto`, and notes the choice in it; otherwise voxel and
/// spacing where the file leaves them open (chooseResolution()). Every scene passes here once, between
/// loadScene() and its use. Throws LoadError with file and line if the wish cannot be met, and as
/// chooseFidelity().
VPS_SCENES_API void resolveFidelity(Scene& scene, const ChoiceOptions& options = {});

/// The fidelity as lines of a scene file.
VPS_SCENES_API std::string toToml(const Fidelity& fidelity);

/// "voxel 0.18 mm, spacing 0.35 mm, both sides: 12345 points, 8.1 MB, a step of 900 us by the cost model,
/// ..."
VPS_SCENES_API std::string describe(const FidelityChoice& choice);

}  // namespace vps::scenes
