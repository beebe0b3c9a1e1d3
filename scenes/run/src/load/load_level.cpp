// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/load_level.h"

#include <cstdio>

namespace vps::scenes {

double costRatio(std::size_t level) {
  const LoadLevel &now = kLoadLevels[level], &before = kLoadLevels[level - 1];
  const double points = now.spacing_factor / before.spacing_factor;
  return points * points * now.periods() / before.periods();
}

std::string describe(const LoadLevel& level, const Fidelity& fidelity) {
  const std::string time =
      level.time_divisor == 1 ? "the clock's" : "1/" + std::to_string(level.time_divisor) + " of the clock's";
  char text[120];
  std::snprintf(text, sizeof text, "points every %.3g mm, physics at %.4g Hz, time at %s",
                1e3 * level.spacing_factor * fidelity.spacing_m,
                fidelity.physics_rate_hz / level.rate_divisor, time.c_str());
  return text;
}

std::string describeCost(const LoadLevelChange& change) {
  if (!change.misread_m) return change.cost;
  char text[120];
  std::snprintf(text, sizeof text, "; at the part's pose the least distance changed by %+.2g um",
                1e6 * *change.misread_m);
  return change.cost + text;
}

}  // namespace vps::scenes
