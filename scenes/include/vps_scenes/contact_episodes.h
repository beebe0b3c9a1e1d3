// SPDX-License-Identifier: BSD-3-Clause
// Tells impacts from slides, as figure 9 of the paper does.
#pragma once

#include <span>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/result.h"

namespace vps::scenes {

/// A time during which the part in the hand touches something.
struct ContactEpisode {
  double start_s = 0, end_s = 0;
  int step = -1;
  bool is_slide = false;  ///< the part moved more than kSlideTravel_m while it touched; else it is an impact
};

/// Touching again within this belongs to the same episode: a part that chatters on a surface has hit it once.
/// assumed: below what a hand feels as two events (about 30 ms between taps).
inline constexpr double kEpisodeBridge_s = 0.02;
/// assumed: well above what a bounce covers.
inline constexpr double kSlideTravel_m = 1e-3;

/// The episodes of a trace in order of time, while the hand holds the part (not in phase 3, rest). O(rows).
VPS_SCENES_API std::vector<ContactEpisode> contactEpisodes(std::span<const TraceRow> trace);

}  // namespace vps::scenes
