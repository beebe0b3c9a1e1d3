// SPDX-License-Identifier: BSD-3-Clause
// The same procedure by several seeds of the virtual operator.
#pragma once

#include "vps_scenes/export.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct TrySettings {
  int tries = 10;        ///< at least 1
  unsigned threads = 0;  ///< how many run at once; 0: one for each core
};

/// Runs the procedure with `tries` seeds and returns the run of the first seed that fits, or else of the
/// first seed, with `tries` and `ease_share` filled in: one success shows that the parts go together, and the
/// share says how easily. All seeds are run, except where geometry proves a block: then one. The seeds are
/// scene.hand.seed and from there in steps of the number of scene.steps, since each step of a run takes the
/// next seed. The same bits for any number of threads, but for wall times. Throws as assemble(), and
/// LoadError for a run in real time, for a device that a person moves and for fewer tries than one.
VPS_SCENES_API AssembleResult assembleTries(const Scene& scene, const TrySettings& settings,
                                            const AssembleOptions& options = {});

}  // namespace vps::scenes
