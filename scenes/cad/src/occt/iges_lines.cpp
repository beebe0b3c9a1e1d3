// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "import/readers.h"
#include "occt/file_faults.h"

namespace vps::scenes::import {

std::optional<std::string> withPlainLines(std::string_view text) {
  constexpr std::size_t kColumns = 80;
  constexpr std::string_view kBlank = " \t\r\n";
  const std::string_view rest = withoutByteOrderMark(text);
  const std::string_view lines = rest.substr(0, rest.find_last_not_of(kBlank) + 1);
  bool is_changed = rest.size() < text.size() || rest.size() - lines.size() > 2;
  std::string out;
  out.reserve(lines.size() + 1);
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size());
    std::string_view line = lines.substr(at, end - at);
    line = line.substr(0, line.find_last_not_of('\r') + 1);
    if (line.size() > kColumns && line.find_first_not_of(kBlank, kColumns) == std::string_view::npos) {
      line = line.substr(0, kColumns);
      is_changed = true;
    }
    out.append(line).append("\n");
    at = end + 1;
  }
  return is_changed ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace vps::scenes::import
