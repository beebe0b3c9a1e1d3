// SPDX-License-Identifier: BSD-3-Clause
// Contact episodes of a trace, divided into impacts and slides as in figure 9 of Tripicchio et al.
#pragma once

#include <span>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

/// An interval in which the part in hand is in contact.
struct ContactEpisode {
  double start_s = 0, end_s = 0;
  int step = -1;
  bool is_slide = false;  ///< the part moved more than kSlideTravel_m in contact; false: an impact
};

/// Contacts separated by less than this time belong to one episode: a part that chatters on a surface has hit
/// the surface once. assumed: shorter than what a hand feels as two events (about 30 ms between taps).
inline constexpr double kEpisodeBridge_s = 0.02;
/// Least travel of a slide. assumed: well above the travel of a bounce.
inline constexpr double kSlideTravel_m = 1e-3;

/// The episodes of a trace in order of time, without TracePhase::Rest. O(rows).
VPS_SCENES_API std::vector<ContactEpisode> contactEpisodes(std::span<const TraceRow> trace);

}  // namespace vps::scenes
