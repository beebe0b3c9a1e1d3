// SPDX-License-Identifier: BSD-3-Clause
// The pairs that a check measures.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "rules/pair_choice.h"
#include "surface/placed_surface.h"

namespace vps::scenes {

struct AskedPairs {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< in ascending order
  /// For each pair, the clearance up to which the pair is reported: CheckSettings::near_m, or the least
  /// clearance that a rule asks of the pair, if greater.
  std::vector<double> near_m;
  std::vector<LeftOutPair> left_out;
};

/// The pairs that are near each other and that the settings ask for. A pair that is not in the result, or
/// that checkPair() does not report with the pair's near_m, keeps the least clearance of every rule, whatever
/// the errors of its meshes. Throws LoadError if a pattern of the settings matches no part.
AskedPairs askedPairs(const std::vector<PlacedSurface>& parts, const CheckSettings& settings);

/// The choice of a check whose result has these patterns.
PairChoice choiceOf(const std::vector<PlacedSurface>& parts, const CheckResult& result);

}  // namespace vps::scenes
