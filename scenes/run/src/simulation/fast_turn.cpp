// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "vps_scenes/run/simulate.h"

namespace vps::scenes {

namespace {

std::string found(const FastTurn& turn) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  char words[400];
  std::snprintf(words, sizeof words,
                "'%s' turns %swith %.0f rpm, %.3g degrees in a step; %s %.3g: ", turn.part.c_str(),
                turn.is_in_contact ? "against a part in contact " : "", turn.w_rad_s * 30 / std::numbers::pi,
                turn.turn_rad * kDegrees,
                turn.is_in_contact ? "contacts may miss teeth and corners where bodies turn by more than"
                                   : "Bullet turns a body by less than its speed requires, above",
                turn.limit_rad * kDegrees);
  return words;
}

std::string rateFor(const FastTurn& turn) {
  char words[100];
  std::snprintf(words, sizeof words, "physics_rate_hz = %.0f or more", std::ceil(turn.needed_hz));
  return words;
}

}  // namespace

std::string inWords(const FastTurn& turn) {
  return found(turn) + rateFor(turn) + ", or substeps = \"auto\", keeps this limit";
}

std::string inWords(const std::vector<FastTurn>& turns, const Fidelity& fidelity) {
  if (turns.empty()) return {};
  const FastTurn& worst = *std::ranges::max_element(turns, {}, &FastTurn::needed_hz);
  const bool is_auto = fidelity.substeps == 0;
  std::string words = is_auto ? found(worst) + rateFor(worst) + " keeps this limit" : inWords(worst);
  const std::size_t others = turns.size() - 1;
  if (others > 0)
    words += " (and " + std::to_string(others) + (others == 1 ? " other part" : " other parts") +
             " that turned too fast)";
  return words;
}

}  // namespace vps::scenes
