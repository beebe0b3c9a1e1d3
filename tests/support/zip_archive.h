// SPDX-License-Identifier: BSD-3-Clause
// Writes zip archives, as 3MF files are.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace vps::test {

inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
  }
  return ~crc;
}

/// A zip archive whose files are stored as they are.
class ZipArchive {
 public:
  void add(const std::string& name, const std::string& bytes) {
    std::string common;
    put<std::uint16_t>(common, {20, 0, 0, 0, 0x21});  // version, flags, stored, time, date
    put<std::uint32_t>(common, {crc32(bytes), std::uint32_t(bytes.size()), std::uint32_t(bytes.size())});
    put<std::uint16_t>(common, {std::uint16_t(name.size()), 0});
    std::string entry = "PK\x01\x02";
    put<std::uint16_t>(entry, {20});
    entry += common;
    put<std::uint16_t>(entry, {0, 0, 0});
    put<std::uint32_t>(entry, {0, std::uint32_t(files_.size())});
    directory_ += entry + name;
    files_ += "PK\x03\x04" + common + name + bytes;
    ++count_;
  }
  [[nodiscard]] std::string bytes() const {
    std::string end = "PK\x05\x06";
    put<std::uint16_t>(end, {0, 0, count_, count_});
    put<std::uint32_t>(end, {std::uint32_t(directory_.size()), std::uint32_t(files_.size())});
    put<std::uint16_t>(end, {0});
    return files_ + directory_ + end;
  }

 private:
  template <typename T>
  static void put(std::string& to, std::initializer_list<T> values) {
    for (const T& value : values) to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string files_, directory_;
  std::uint16_t count_ = 0;
};

}  // namespace vps::test
