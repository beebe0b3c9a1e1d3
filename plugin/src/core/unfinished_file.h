// SPDX-License-Identifier: BSD-3-Clause
// Files are made under another name first: whoever reads one finds the old or the new, never half of it.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace vps {

/// A name beside `file` that no other writer uses, to be renamed to `file` once it is whole: by its program,
/// and within that by a count. Thread-safe.
inline std::filesystem::path unfinishedName(const std::filesystem::path& file) {
  static std::atomic<unsigned> count = 0;
  std::filesystem::path name = file;
  name += "." + std::to_string(getpid()) + "." + std::to_string(count++) + ".unfinished";
  return name;
}

}  // namespace vps
