// SPDX-License-Identifier: BSD-3-Clause
// The interface of a fuzz program: an entry point for bytes, in libFuzzer's form, and seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Reads the bytes and checks the properties that the reader promises for its result; aborts if one does not
/// hold. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vps::fuzz {

/// Valid inputs, from which the driver makes changed ones.
std::vector<std::string> seeds();

/// Aborts with a message unless the claim holds.
void require(bool claim, const char* message);

/// The name of a file that holds the bytes until the next call; it is always the same name.
std::string fileOf(const std::uint8_t* data, std::size_t size);

/// A file's bytes.
std::string bytesOf(const std::string& file);

}  // namespace vps::fuzz
