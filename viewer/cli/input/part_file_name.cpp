// SPDX-License-Identifier: BSD-3-Clause
#include "input/part_file_name.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace vps::viewer {

std::string partFileName(const std::string& name, const std::string& extension,
                         std::set<std::string>& taken) {
  std::string stem;
  for (const unsigned char c : name)
    stem += std::isalnum(c) || c == '-' || c == '_' ? static_cast<char>(c) : '_';
  constexpr std::size_t kLongest = 100;  // bytes; file systems take 255, and names of folders come before
  if (stem.size() > kLongest) stem.resize(kLongest);
  if (stem.empty()) stem = "part";
  // "A.stl" and "a.stl" are one file on some systems.
  const auto isNew = [&](std::string file) {
    std::ranges::transform(file, file.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return taken.insert(std::move(file)).second;
  };
  std::string file = stem + extension;
  for (int i = 2; !isNew(file); ++i) file = stem + "_" + std::to_string(i) + extension;
  return file;
}

}  // namespace vps::viewer
