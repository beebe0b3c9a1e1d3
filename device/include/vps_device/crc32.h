// SPDX-License-Identifier: BSD-3-Clause
// The checksum of Ethernet, zip and MCAP.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "vps_device/export.h"

namespace vps::device {

/// CRC-32 (reflected polynomial 0xedb88320, as ISO-HDLC), over bytes that come piece by piece. O(bytes).
class VPS_DEVICE_API Crc32 {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) crc_ = kTable[(crc_ ^ static_cast<unsigned char>(c)) & 0xff] ^ (crc_ >> 8);
  }
  [[nodiscard]] std::uint32_t value() const { return ~crc_; }

 private:
  static constexpr std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t crc = i;
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
      table[i] = crc;
    }
    return table;
  }();
  std::uint32_t crc_ = 0xffffffffu;
};

inline std::uint32_t crc32(std::string_view bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace vps::device
