// SPDX-License-Identifier: BSD-3-Clause
#include "lib3mf/archive.h"

#include <minizip/unzip.h>

#include <array>
#include <memory>

#include "assimp/xml_tags.h"
#include "import/stored_archive.h"

namespace vps::scenes::import {
namespace {

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
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

}  // namespace vps::scenes::import
