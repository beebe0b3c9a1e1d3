// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <numbers>

#include "vps_scenes/result.h"

namespace vps::scenes::inline v0 {

std::string inWords(const FastTurn& turn) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  char words[400];
  std::snprintf(
      words, sizeof words,
      "'%s' turns %swith %.0f rpm, %.3g degrees in a step; %s more than %.3g: physics_rate_hz = %.0f "
      "or more, or substeps = \"auto\", holds it",
      turn.part.c_str(), turn.is_in_contact ? "against what it touches " : "",
      turn.w_rad_s * 30 / std::numbers::pi, turn.turn_rad * kDegrees,
      turn.is_in_contact ? "contacts may miss teeth and corners where bodies turn by"
                         : "Bullet turns no body by",
      turn.limit_rad * kDegrees, std::ceil(turn.needed_hz));
  return words;
}

}  // namespace vps::scenes::inline v0
