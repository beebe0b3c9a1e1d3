// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/load_level.h"

#include <cstdio>

namespace vps::scenes {

double dearerBefore(std::size_t level) {
  const LoadLevel &now = kLoadLevels[level], &before = kLoadLevels[level - 1];
  const double points = now.coarser / before.coarser;
  return points * points * now.periods() / before.periods();
}

std::string describe(const LoadLevel& pace, const Fidelity& fidelity) {
  char text[120];
  std::snprintf(
      text, sizeof text, "points every %.3g mm, physics at %.4g Hz, time at %s",
      1e3 * pace.coarser * fidelity.spacing_m, fidelity.physics_rate_hz / pace.rate_divisor,
      pace.slower == 1 ? "the clock's" : ("1/" + std::to_string(pace.slower) + " of the clock's").c_str());
  return text;
}

std::string inWords(const LoadLevelChange& change) {
  if (!change.misread_m) return change.cost;
  char text[100];
  std::snprintf(text, sizeof text, "; where the part was, its distance reads %+.2g um against before",
                1e6 * *change.misread_m);
  return change.cost + text;
}

}  // namespace vps::scenes
