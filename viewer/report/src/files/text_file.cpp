// SPDX-License-Identifier: BSD-3-Clause
#include "files/text_file.h"

#include <fstream>
#include <iterator>

namespace vps::viewer {

std::string textOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace vps::viewer
