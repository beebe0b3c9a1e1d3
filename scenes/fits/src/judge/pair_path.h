// SPDX-License-Identifier: BSD-3-Clause
// The relative motion of a pair of bodies along some steps. Moments are counted in steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vps::scenes {

/// Arcs are replaced by chords that leave them by at most this, a fraction of the tolerance.
inline constexpr double kChord_m = 0.25e-6;
inline constexpr double kMostChords = 64;
/// Into how many chords an arc is divided that leaves its own by so much.
inline double chordsOf(double sagitta_m) {
  return std::max(1.0, std::ceil(std::sqrt(sagitta_m / kChord_m)));
}

struct PairPath {
  std::pair<std::size_t, std::size_t> pair;
  std::size_t a, b;               ///< the one that is fixed, or else the larger one, first
  std::vector<double> travel_m;   ///< relative travel since the first moment, by moment
  std::vector<double> sagitta_m;  ///< see RelativeMotion; by step
  double end_depth_m = 0;         ///< upper bound at the last moment
  int searches = 0;               ///< of a direction that separates their hulls, in vain
  int failures = 0;               ///< of proofs that their surfaces do not meet, beyond those that succeeded

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
