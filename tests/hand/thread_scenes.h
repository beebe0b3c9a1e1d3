// SPDX-License-Identifier: BSD-3-Clause
// Nuts above threaded rods, as scenes for the virtual operator.
#pragma once

#include <cstdint>

#include "peg_scenes.h"

namespace vps::hand {

/// A nut with a coarse right-hand thread (12 mm, pitch 3 mm) above an upright rod. The target is this far
/// below where the nut meets the rod.
scenes::Scene coarseThread(double depth_m, std::uint64_t seed);

/// The same, aimed with a standard deviation of six degrees, so that the nut may start crossed.
scenes::Scene leaningNut(double depth_m, std::uint64_t seed);

/// The same nut over a smooth rod that it passes: nothing catches.
scenes::Scene smoothRod(double depth_m, std::uint64_t seed);

/// The nut and bolt in the folder $VPS_CAD_DIR/thread-m16-loose, from above the first thread. Throws
/// LoadError without it.
scenes::Scene looseM16(double depth_m, std::uint64_t seed);

/// coarse_thread: two turns; leaning_nut: one; smooth_rod; m16: 10 mm down, five turns.
const std::vector<PegScene>& threadScenes();

}  // namespace vps::hand
