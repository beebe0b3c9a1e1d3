// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/query_state.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vps::bullet::inline v0 {

namespace {

// Points of a surface tile, four by four: where more points are near than smallQueryLimit(), there are more
// tiles than contacts. Tiles are larger where a shell would have more than sixteen of them for each contact.
constexpr std::size_t kTilePoints = 16;
constexpr double kTileSpacings = 6;  // the diagonal and a margin
constexpr double kMaxTiles = 16;

double tileSize_m(const PointShell& shell, const Settings& settings) {
  const double area_m2 = std::accumulate(shell.area_m2.begin(), shell.area_m2.end(), 0.0);
  return std::max(kTileSpacings * shell.spacing_m,
                  std::sqrt(2 * area_m2 / (kMaxTiles * settings.contact_limit)));
}

}  // namespace

void QueryState::lead(const PointShell& shell, std::span<const std::uint8_t> on_edge,
                      const Settings& settings) {
  leading.emplace(shell, tileSize_m(shell, settings), on_edge);
}

// Every penalty point counts; of the points of rigid contact only a few do.
bool needsLeading(std::size_t near_points, const PointShell& shell, const Settings& settings) {
  return settings.contact_method == ContactMethod::Constraint && near_points > smallQueryLimit(settings) &&
         shell.spacing_m > 0;
}

std::size_t smallQueryLimit(const Settings& settings) {
  return kTilePoints * static_cast<std::size_t>(settings.contact_limit);
}

}  // namespace vps::bullet::inline v0
