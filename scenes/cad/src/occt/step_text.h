// SPDX-License-Identifier: BSD-3-Clause
// Steps through the text of a STEP file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace vps::scenes::import {

/// The position after the first `end` from `at` on; the text's size if there is none.
inline std::size_t after(std::string_view text, std::size_t at, std::string_view end) {
  const std::size_t found = text.find(end, std::min(at, text.size()));
  return found == std::string_view::npos ? text.size() : found + end.size();
}

inline std::size_t afterBlanksAndComments(std::string_view text, std::size_t at) {
  while ((at = std::min(text.find_first_not_of(" \t\r\n", at), text.size())) < text.size() &&
         text.substr(at).starts_with("/*"))
    at = after(text, at + 2, "*/");
  return at;
}

}  // namespace vps::scenes::import
