// SPDX-License-Identifier: BSD-3-Clause
// Writes zip archives, the container of 3MF files.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "vps_device/detail/bytes.h"

namespace vps::scenes::import {

/// A zip archive of uncompressed files [APPNOTE.TXT 6.3.10].
class StoredArchive {
 public:
  void add(std::string_view name, std::string_view bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::string common;
    put<std::uint16_t>(common, {20, 0, 0, 0, 0x21});  // version, flags, stored, time, date
    put<std::uint32_t>(common, {device::crc32(bytes), size, size});
    put<std::uint16_t>(common, {static_cast<std::uint16_t>(name.size()), 0});
    directory_ += "PK\x01\x02";
    put<std::uint16_t>(directory_, {20});
    directory_ += common;
    put<std::uint16_t>(directory_, {0, 0, 0});
    put<std::uint32_t>(directory_, {0, static_cast<std::uint32_t>(files_.size())});
    directory_ += name;
    files_.append("PK\x03\x04").append(common).append(name).append(bytes);
    ++count_;
  }
  [[nodiscard]] std::size_t size() const { return files_.size() + directory_.size(); }
  /// Ends the archive with its directory; nothing can be added afterwards.
  std::string finish() && {
    const auto files = static_cast<std::uint32_t>(files_.size());
    files_ += directory_;
    files_ += "PK\x05\x06";
    put<std::uint16_t>(files_, {0, 0, count_, count_});
    put<std::uint32_t>(files_, {static_cast<std::uint32_t>(directory_.size()), files});
    put<std::uint16_t>(files_, {0});
    return std::move(files_);
  }

 private:
  template <typename T>
  static void put(std::string& to, std::initializer_list<T> values) {
    for (const T value : values)
      for (std::size_t byte = 0; byte < sizeof value; ++byte)
        to += static_cast<char>(value >> (8 * byte) & 0xFF);
  }
  std::string files_, directory_;
  std::uint16_t count_ = 0;
};

}  // namespace vps::scenes::import
