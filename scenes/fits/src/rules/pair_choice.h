// SPDX-License-Identifier: BSD-3-Clause
// Pairs of parts that are chosen by patterns of names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_wishes.h"

namespace vps::scenes {

/// The names by which a part can be chosen.
struct PartNames {
  std::string name;
  std::vector<std::string> within;  ///< names of assemblies that contain the part
};

/// The pairs that match a pattern.
class MatchedPairs {
 public:
  /// Throws LoadError if one side of the pattern matches no part, or both sides only one and the same part.
  /// The message has the nearest name.
  MatchedPairs(const PairPattern& pattern, const std::vector<PartNames>& parts);
  /// All pairs of the parts.
  static MatchedPairs all(const std::vector<PartNames>& parts);
  /// Whether two parts, given by their indices, are a pair of the pattern. O(1).
  [[nodiscard]] bool has(std::size_t i, std::size_t k) const {
    return (is_a_[i] && is_b_[k]) || (is_a_[k] && is_b_[i]);
  }

 private:
  MatchedPairs() = default;
  std::vector<bool> is_a_, is_b_;
};

/// Which pairs of an assembly a check measures.
class PairChoice {
 public:
  /// The arguments are those of CheckSettings. Throws LoadError, as MatchedPairs does.
  PairChoice(const std::vector<PairPattern>& between, const std::vector<PairPattern>& ignored,
             const std::vector<PartNames>& parts);
  [[nodiscard]] bool has(std::size_t i, std::size_t k) const;
  /// The description of a pair for which has() is false.
  [[nodiscard]] LeftOutPair leftOut(std::size_t i, std::size_t k) const;

 private:
  std::vector<MatchedPairs> between_, ignored_;
  std::vector<PairPattern> ignored_patterns_;
  std::vector<std::string> names_;
};

}  // namespace vps::scenes
