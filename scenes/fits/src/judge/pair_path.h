// SPDX-License-Identifier: BSD-3-Clause
// The relative motion of a pair of bodies along some steps. Moments are counted in steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vps::scenes {

/// Greatest distance of an arc from the chords that replace it; a fraction of the search's tolerance.
inline constexpr double kChord_m = 0.25e-6;
inline constexpr double kMostChords = 64;
/// Number of chords that replace an arc whose distance from its own chord is sagitta_m.
inline double chordsOf(double sagitta_m) {
  return std::max(1.0, std::ceil(std::sqrt(sagitta_m / kChord_m)));
}

/// The relative motion of two bodies along some steps.
struct PairPath {
  std::pair<std::size_t, std::size_t> pair;
  std::size_t a, b;               ///< `a` is the fixed body of the pair, or else the larger body
  std::vector<double> travel_m;   ///< by moment: relative travel since the first moment
  std::vector<double> sagitta_m;  ///< by step: see RelativeMotion
  double end_depth_m = 0;         ///< upper bound of the depth at the last moment
  int searches = 0;               ///< number of failed searches for a direction that separates the hulls
  int failures = 0;               ///< number of failed minus successful proofs that the surfaces do not meet

  [[nodiscard]] double travelAt(double step) const {
    const auto i = std::min(static_cast<std::size_t>(step), travel_m.size() - 1);
    if (i + 1 == travel_m.size()) return travel_m[i];
    return std::lerp(travel_m[i], travel_m[i + 1], step - static_cast<double>(i));
  }
  [[nodiscard]] double stepAt(double travelled_m) const {
    const auto next = std::upper_bound(travel_m.begin(), travel_m.end(), travelled_m);
    if (next == travel_m.end()) return static_cast<double>(travel_m.size() - 1);
    if (next == travel_m.begin()) return 0;
    const auto i = static_cast<std::size_t>(next - travel_m.begin()) - 1;
    return static_cast<double>(i) + (travelled_m - travel_m[i]) / (travel_m[i + 1] - travel_m[i]);
  }
};

}  // namespace vps::scenes
