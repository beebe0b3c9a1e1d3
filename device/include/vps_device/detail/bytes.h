// SPDX-License-Identifier: BSD-3-Clause
// Serialises numbers and texts, least significant byte first on every machine, and checksums them. Doubles
// keep every bit, including those of NaN and -0.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "vps_device/export.h"

namespace vps::device {

/// Appends to a string. The caller's format chooses the type of length prefixes.
class VPS_DEVICE_API ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  template <std::unsigned_integral T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) out_.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  }
  void put(std::int32_t value) { put(static_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void bytes(std::string_view bytes) { out_.append(bytes); }

  /// Appends a length of type Length, then the bytes. The length must fit into Length.
  template <std::unsigned_integral Length = std::uint32_t>
  void text(std::string_view text) {
    put(static_cast<Length>(text.size()));
    bytes(text);
  }

 private:
  std::string& out_;
};

/// Reads from untrusted bytes: missing data reads as zero or empty and makes isGood() false from then on.
/// Never reads past the end, never allocates.
class VPS_DEVICE_API ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool isGood() const { return is_good_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  template <std::unsigned_integral T>
  T get() {
    const std::string_view from = take(sizeof(T));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(from[i])) << (8 * i);
    return static_cast<T>(value);
  }
  std::int32_t getInt() { return static_cast<std::int32_t>(get<std::uint32_t>()); }
  double getDouble() { return std::bit_cast<double>(get<std::uint64_t>()); }
  float getFloat() { return std::bit_cast<float>(get<std::uint32_t>()); }

  /// The next `count` bytes; if fewer are left, returns empty, and isGood() becomes false.
  std::string_view take(std::uint64_t count) {
    if (!is_good_ || count > bytes_.size()) {
      is_good_ = false;
      return {};
    }
    const std::string_view taken = bytes_.substr(0, static_cast<std::size_t>(count));
    bytes_.remove_prefix(static_cast<std::size_t>(count));
    return taken;
  }
  /// Reads a length of type Length, then that number of bytes.
  template <std::unsigned_integral Length = std::uint32_t>
  std::string_view text() {
    return take(get<Length>());
  }

 private:
  std::string_view bytes_;
  bool is_good_ = true;
};

/// CRC-32, the checksum of Ethernet, zip and MCAP (reflected polynomial 0xedb88320, as ISO-HDLC).
/// @param crc  of the preceding bytes, to continue a checksum; 0 to begin one
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
