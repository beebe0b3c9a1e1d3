// SPDX-License-Identifier: BSD-3-Clause
#include "import/lib3mf/archive.h"

#include <minizip/unzip.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>

#include "import/xml_tags.h"

namespace vps::scenes::inline v0::import {
namespace {

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};

std::uint32_t crc32(std::string_view bytes) {
  constexpr std::uint32_t kPolynomial = 0xEDB88320U;  // of the zip format
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < made.size(); ++i) {
      made[i] = i;
      for (int bit = 0; bit < 8; ++bit) made[i] = made[i] >> 1 ^ ((made[i] & 1) != 0 ? kPolynomial : 0);
    }
    return made;
  }();
  std::uint32_t crc = ~0U;
  for (const char c : bytes) crc = crc >> 8 ^ table[(crc ^ static_cast<unsigned char>(c)) & 0xFF];
  return ~crc;
}

/// A zip archive whose files are stored as they are [APPNOTE.TXT 6.3.10].
class StoredArchive {
 public:
  void add(std::string_view name, std::string_view bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::string common;
    put<std::uint16_t>(common, {20, 0, 0, 0, 0x21});  // version, flags, stored, time, date
    put<std::uint32_t>(common, {crc32(bytes), size, size});
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
  /// With the directory behind the files; then nothing can be added.
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

}  // namespace

void forEachFile(const std::string& archive, std::size_t most_bytes,
                 const std::function<bool(std::string_view name, std::string& text)>& f) {
  const std::unique_ptr<void, CloseZip> zip(unzOpen64(archive.c_str()));
  if (!zip || unzGoToFirstFile(zip.get()) != UNZ_OK) return;
  do {
    std::array<char, 1024> name{};
    if (unzGetCurrentFileInfo64(zip.get(), nullptr, name.data(), name.size() - 1, nullptr, 0, nullptr, 0) !=
            UNZ_OK ||
        unzOpenCurrentFile(zip.get()) != UNZ_OK)
      continue;
    std::string text;
    std::array<char, 65536> block{};
    int got = 0;
    while (text.size() < most_bytes &&
           (got = unzReadCurrentFile(zip.get(), block.data(), static_cast<unsigned>(block.size()))) > 0)
      text.append(block.data(), static_cast<std::size_t>(got));
    unzCloseCurrentFile(zip.get());
    if (!f(std::string_view(name.data()), text)) return;
  } while (unzGoToNextFile(zip.get()) == UNZ_OK);
}

std::string withoutNumbersForCharacters(const std::string& archive) {
  constexpr std::size_t kMostBytes = 0xF0000000, kMostFiles = 0xFFFF;  // without the 64-bit extension of zip
  StoredArchive copy;
  bool has_any = false, is_small = true;
  std::size_t count = 0;
  forEachFile(archive, kWholeFile, [&](std::string_view name, std::string& text) {
    std::optional<std::string> changed;
    if (isModel(name)) changed = withoutNumbersForCharacters(std::string_view(text));
    has_any = has_any || changed;
    is_small = ++count < kMostFiles && copy.size() + text.size() < kMostBytes;
    if (is_small) copy.add(name, changed ? *changed : text);
    return is_small;
  });
  return has_any && is_small ? std::move(copy).finish() : "";
}

}  // namespace vps::scenes::inline v0::import
