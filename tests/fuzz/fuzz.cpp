// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace vps::fuzz {

void require(bool claim, const char* message) {
  if (claim) return;
  std::fprintf(stderr, "broken promise: %s\n", message);
  std::abort();
}

std::string fileOf(const std::uint8_t* data, std::size_t size) {
  static const std::string file =
      (std::filesystem::temp_directory_path() / ("vps_fuzz_" + std::to_string(getpid()))).string();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace vps::fuzz
