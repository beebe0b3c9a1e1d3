// SPDX-License-Identifier: BSD-3-Clause
// Gives each name another one where it is repeated.
#pragma once

#include <map>
#include <set>
#include <string>

namespace vps::scenes::import {

class UniqueNames {
 public:
  /// The name, or "<name>_2" and so on where it was given before. O(log n) amortised.
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
  std::map<std::string, int> tried_;  ///< by name: the last number that was tried
};

}  // namespace vps::scenes::import
