// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/contact_episodes.h"

namespace vps::scenes {

std::vector<ContactEpisode> contactEpisodes(std::span<const TraceRow> trace) {
  constexpr int kRest = static_cast<int>(TracePhase::Rest);
  std::vector<ContactEpisode> episodes;
  double travel_m = 0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const TraceRow& row = trace[i];
    if (row.contacts <= 0 || row.phase == kRest) continue;
    const bool is_same = !episodes.empty() && episodes.back().step == row.step &&
                         row.time_s - episodes.back().end_s <= kEpisodeBridge_s;
    if (!is_same) {
      episodes.push_back({row.time_s, row.time_s, row.step, false});
      travel_m = 0;
    } else {
      travel_m += (row.X_WP.p - trace[i - 1].X_WP.p).norm();
    }
    episodes.back().end_s = row.time_s;
    episodes.back().is_slide = travel_m > kSlideTravel_m;
  }
  return episodes;
}

}  // namespace vps::scenes
