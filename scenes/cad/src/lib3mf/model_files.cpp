// SPDX-License-Identifier: BSD-3-Clause
#include "lib3mf/model_files.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <sstream>
#include <string_view>

#include "assimp/xml_tags.h"
#include "core/valid_text.h"
#include "lib3mf/stored_archive.h"

namespace vps::scenes::import {
namespace {

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};

constexpr std::size_t kWholeFile = std::numeric_limits<std::size_t>::max();

/// Calls f(name, text) for each file of an archive, with about the first `most_bytes` bytes of the file,
/// until f returns false. If a file cannot be unpacked, `text` has the bytes before the fault.
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

constexpr std::string_view kRelations = "_rels/.rels";

std::optional<std::string> withoutMissingThumbnails(std::string_view xml,
                                                    const std::set<std::string>& names) {
  std::string out;
  std::size_t copied = 0, at = 0;
  while (const std::optional<XmlTag> tag = nextTag(xml, at)) {
    if (tag->name != "Relationship" || !tag->is_end ||
        !tag->value("Type").value_or("").ends_with("/thumbnail"))
      continue;
    std::string_view target = tag->value("Target").value_or("");
    if (target.starts_with('/')) target.remove_prefix(1);
    if (names.contains(std::string(target))) continue;
    out.append(xml.substr(copied, tag->from - copied));
    copied = tag->end;
  }
  return copied == 0 ? std::nullopt : std::optional(out.append(xml.substr(copied)));
}

bool isModel(std::string_view name) {
  return name.ends_with(".model");
}

bool isNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return false;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return end == text.data() + text.size() && error != std::errc::invalid_argument;
}

std::string faultOf(std::string_view xml) {
  std::size_t at = 0, depth = 0;
  bool has_ended = false;
  while (const std::optional<XmlTag> tag = nextTag(xml, at)) {
    depth += tag->is_begin ? 1 : 0;
    depth -= tag->is_end && depth > 0 ? 1 : 0;
    has_ended = depth == 0;
    if (tag->name != "vertex" || !tag->is_begin) continue;
    for (const std::string_view axis : {"x", "y", "z"})
      if (const auto value = tag->value(axis); value && !isNumber(*value))
        return "has a vertex with " + std::string(axis) + " = \"" + printable(value->substr(0, 40)) +
               "\", which is not a number";
  }
  return has_ended ? "" : "ends before its model does";
}

ModelFile modelFile(std::string_view name, const std::optional<XmlTag>& model) {
  ModelFile file;
  file.name = name;
  if (!model) return file;
  if (const auto unit = model->value("unit")) file.unit = *unit;
  std::istringstream prefixes{std::string(model->value("requiredextensions").value_or(""))};
  for (std::string prefix; prefixes >> prefix;)
    file.required.emplace_back(model->value("xmlns:" + prefix).value_or(""));
  return file;
}

}  // namespace

std::string readableArchive(const std::string& archive) {
  constexpr std::size_t kMostBytes = 0xF0000000, kMostFiles = 0xFFFF;  // without the 64-bit extension of zip
  StoredArchive copy;
  bool has_any = false, is_small = true;
  std::size_t count = 0;
  std::set<std::string> names;
  forEachFile(archive, 0,
              [&](std::string_view name, const std::string&) { return names.emplace(name), true; });
  forEachFile(archive, kWholeFile, [&](std::string_view name, std::string& text) {
    std::optional<std::string> changed;
    if (isModel(name)) changed = withoutNumbersForCharacters(std::string_view(text));
    if (name == kRelations) changed = withoutMissingThumbnails(text, names);
    has_any = has_any || changed;
    is_small = ++count < kMostFiles && copy.size() + text.size() < kMostBytes;
    if (is_small) copy.add(name, changed ? *changed : text);
    return is_small;
  });
  return has_any && is_small ? std::move(copy).finish() : "";
}

std::string modelFault(const std::string& archive) {
  std::string fault;
  forEachFile(archive, kWholeFile, [&](std::string_view name, const std::string& text) {
    if (isModel(name) && !text.empty()) fault = faultOf(text);
    if (!fault.empty()) fault = std::string(name) + " " + fault;
    return fault.empty();
  });
  return fault;
}

ModelFiles modelFiles(const std::string& archive) {
  constexpr std::size_t kHead = 65536;
  std::string root;
  std::vector<ModelFile> found;
  forEachFile(archive, kHead, [&](std::string_view name, const std::string& text) {
    std::size_t at = 0;
    if (name == kRelations) {
      while (const std::optional<XmlTag> tag = nextTag(text, at))
        if (tag->name == "Relationship" && tag->value("Type").value_or("").ends_with("/3dmodel"))
          root = tag->value("Target").value_or("");
      if (root.starts_with('/')) root.erase(0, 1);
    } else if (isModel(name)) {
      found.push_back(modelFile(name, nextTag(text, at)));
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

}  // namespace vps::scenes::import
