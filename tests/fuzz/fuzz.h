// SPDX-License-Identifier: BSD-3-Clause
// The interface of a fuzz program: an entry point for bytes, in libFuzzer's form, and inputs to start from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Reads the bytes and checks the properties that the reader promises of its result; aborts if one does not
/// hold. Returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vps::fuzz {

/// Valid inputs, from which the driver makes others.
std::vector<std::string> seeds();

/// Aborts with a message unless the claim holds.
void require(bool claim, const char* message);

/// A file that holds the bytes until the next call; the same name all along.
std::string fileOf(const std::uint8_t* data, std::size_t size);

/// A file's bytes.
std::string bytesOf(const std::string& file);

}  // namespace vps::fuzz
