// SPDX-License-Identifier: BSD-3-Clause
// The checksum of Ethernet, zip and MCAP.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace vps::device {

/// CRC-32 (reflected polynomial 0xedb88320, as ISO-HDLC).
/// @param crc  of the bytes before, to continue a sum; 0 to begin
/// O(bytes).
inline std::uint32_t crc32(std::string_view bytes, std::uint32_t crc = 0) {
  static constexpr std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? 0xedb88320u ^ (value >> 1) : value >> 1;
      table[i] = value;
    }
    return table;
  }();
  crc = ~crc;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 0xff] ^ (crc >> 8);
  return ~crc;
}

}  // namespace vps::device
