// SPDX-License-Identifier: BSD-3-Clause
#include "import/lib3mf/model_units.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "import/xml_tags.h"

namespace vps::scenes::inline v0::import {
namespace {

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};

/// Calls f(name, text) for each file of an archive with at most this many of its first bytes, while f gives
/// true.
template <class F>
void forEachFile(const std::string& archive, std::size_t most_bytes, F f) {
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

bool isModel(std::string_view name) {
  return name.ends_with(".model");
}

}  // namespace

ModelFiles modelFiles(const std::string& archive) {
  constexpr std::size_t kHead = 65536;
  std::string root;
  std::vector<ModelFile> found;
  forEachFile(archive, kHead, [&](std::string_view name, const std::string& text) {
    std::size_t at = 0;
    if (name == "_rels/.rels") {
      while (const std::optional<XmlTag> tag = nextTag(text, at))
        if (tag->name == "Relationship" && tag->value("Type").value_or("").ends_with("/3dmodel"))
          root = tag->value("Target").value_or("");
      if (root.starts_with('/')) root.erase(0, 1);
    } else if (isModel(name)) {
      ModelFile file{std::string(name)};
      if (const std::optional<XmlTag> tag = nextTag(text, at))
        if (const auto unit = tag->value("unit")) file.unit = *unit;
      found.push_back(std::move(file));
    }
    return true;
  });
  ModelFiles files;
  for (ModelFile& file : found) {
    if (file.name == root)
      files.root = std::move(file);
    else
      files.others.push_back(std::move(file));
  }
  return files;
}

bool hasNumbersForCharacters(const std::string& archive) {
  bool has = false;
  forEachFile(archive, std::string::npos, [&](std::string_view name, const std::string& text) {
    has = isModel(name) && text.find("&#") != std::string::npos;
    return !has;
  });
  return has;
}

}  // namespace vps::scenes::inline v0::import
