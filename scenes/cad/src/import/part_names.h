// SPDX-License-Identifier: BSD-3-Clause
// Chooses the most meaningful name of a part, keeps names unique, and matches names with patterns.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace vps::scenes::import {

/// The more meaningful one of the names of an instance and of its product. Names that exporters generate are
/// ignored: counters, identifiers and kinds of shapes ("NAUO7", "=>[0:1:1:2]", "3f2a9c40-...", "SOLID").
/// Words that any part could have ("Body1", "Part 2"), names with lost characters, and long words of random
/// characters are only taken if there is no other name. An instance that only numbers its product ("bolt:3",
/// "bolt<3>") gets the product's name. Empty if neither name is meaningful.
std::string bestName(const std::string& instance, const std::string& product);

/// Whether a name matches a pattern, in which * stands for any text. O(length of the name x length of the
/// pattern).
bool matchesPattern(std::string_view name, std::string_view pattern);

/// Gives out each name once.
class UniqueNames {
 public:
  /// The name, or "<name>_2" and so on if the name was given out before. O(log n) amortised.
  std::string unique(const std::string& name) {
    if (taken_.insert(name).second) return name;
    int& n = tried_.try_emplace(name, 1).first->second;
    std::string other;
    do other = name + "_" + std::to_string(++n);
    while (!taken_.insert(other).second);
    return other;
  }

 private:
  std::set<std::string> taken_;
  std::map<std::string, int> tried_;  ///< last number that was tried for each repeated name
};

}  // namespace vps::scenes::import
