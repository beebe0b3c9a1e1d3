// SPDX-License-Identifier: BSD-3-Clause
// Words for a shell.
#pragma once

#include <string>

namespace vps::viewer {

/// A word of a POSIX shell.
inline std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace vps::viewer
