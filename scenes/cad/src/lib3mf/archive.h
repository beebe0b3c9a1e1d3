// SPDX-License-Identifier: BSD-3-Clause
// The files in a 3MF archive as texts, by minizip, for what lib3mf 1.8.1 does not tell or misreads.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace vps::scenes::import {

inline constexpr std::size_t kWholeFile = std::numeric_limits<std::size_t>::max();

/// Calls f(name, text) for each file of an archive with at most about this many of its first bytes, while f
/// gives true. A file that cannot be unpacked has the bytes before the fault.
void forEachFile(const std::string& archive, std::size_t most_bytes,
                 const std::function<bool(std::string_view name, std::string& text)>& f);

inline bool isModel(std::string_view name) {
  return name.ends_with(".model");
}

/// A copy of the archive, uncompressed, in which the model files have characters in place of their numbers
/// ("&#228;"), which lib3mf 1.8.1 refuses; empty if no model file has such a number, or beyond 4 GB.
std::string withoutNumbersForCharacters(const std::string& archive);

}  // namespace vps::scenes::import
