// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/query_state.h"

#include <algorithm>

namespace vps::bullet {

namespace {

// Points of a surface tile, four by four: where more points are near than smallQueryLimit(), there are more
// tiles than contacts.
constexpr std::size_t kTilePoints = 16;
constexpr double kTileSpacings = 6;  // the diagonal and a margin
// Tiles of a dense shell are larger: three of the cells in which the most urgent candidate is kept
// afterwards. Neither depends on how many points of the shell are left: contact must not change when it is
// cropped.
constexpr double kTileShare = 0.18;  // of the smaller body's radius

}  // namespace

void QueryState::lead(const PointShell& shell, std::span<const std::uint8_t> on_edge, double radius_m) {
  leading.emplace(shell, std::max(kTileSpacings * shell.spacing_m, kTileShare * radius_m), on_edge);
}

// Every penalty point counts; of the points of rigid contact only a few do.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings) {
  return settings.contact_method == ContactMethod::Constraint && near_points > smallQueryLimit(settings) &&
         shell.spacing_m > 0;
}

std::size_t refinedLimit(const Settings& settings) {
  return 4 * static_cast<std::size_t>(settings.contact_limit);
}

std::size_t smallQueryLimit(const Settings& settings) {
  return kTilePoints * static_cast<std::size_t>(settings.contact_limit);
}

}  // namespace vps::bullet
