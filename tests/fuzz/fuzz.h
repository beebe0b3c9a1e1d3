// SPDX-License-Identifier: BSD-3-Clause
// The interface of a fuzz program: an entry point for bytes, in libFuzzer's form, and inputs to start from.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/// Reads the bytes and checks the properties that the reader promises for its result; aborts if a property
/// does not hold. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vps::fuzz {

/// Valid inputs, from which the driver makes others.
std::vector<std::string> seeds();

/// Aborts with a message unless the claim holds.
inline void require(bool claim, const char* message) {
  if (claim) return;
  std::fprintf(stderr, "broken promise: %s\n", message);
  std::abort();
}

/// The name of a file that holds the bytes until the next call; the name is always the same.
inline std::string fileOf(const std::uint8_t* data, std::size_t size) {
  static const std::string file =
      (std::filesystem::temp_directory_path() / ("vps_fuzz_" + std::to_string(getpid()))).string();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

/// A file's bytes.
inline std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace vps::fuzz
