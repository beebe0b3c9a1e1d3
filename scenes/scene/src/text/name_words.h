// SPDX-License-Identifier: BSD-3-Clause
// Names of parts in sentences.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace vps::scenes {

inline std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

/// "'a', 'b' and 'c'"
/// @param most  are named; of more names, how many others there are is said
inline std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + quoted(names[i]);
  return names.size() > most ? out + " and " + std::to_string(names.size() - most) + " more" : out;
}

}  // namespace vps::scenes
