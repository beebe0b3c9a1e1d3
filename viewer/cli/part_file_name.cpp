// SPDX-License-Identifier: BSD-3-Clause
#include "part_file_name.h"

#include <cctype>

namespace vps::viewer::inline v0 {

std::string partFileName(const std::string& name, const std::string& extension,
                         std::set<std::string>& taken) {
  std::string stem;
  for (const unsigned char c : name)
    stem += std::isalnum(c) || c == '-' || c == '_' ? static_cast<char>(c) : '_';
  if (stem.empty()) stem = "part";
  std::string file = stem + extension;
  for (int i = 2; !taken.insert(file).second; ++i) file = stem + "_" + std::to_string(i) + extension;
  return file;
}

}  // namespace vps::viewer::inline v0
