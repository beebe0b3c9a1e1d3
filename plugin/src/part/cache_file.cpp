// SPDX-License-Identifier: BSD-3-Clause
#include "part/cache_file.h"

#include <cstdio>

namespace vps {

std::string nameOf(const Digest& key) {
  std::array<char, 33> text;
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(key[0]),
                static_cast<unsigned long long>(key[1]));
  return text.data();
}

}  // namespace vps
