// SPDX-License-Identifier: BSD-3-Clause
#include "lib3mf/model_units.h"

#include <algorithm>
#include <sstream>

#include "assimp/xml_tags.h"
#include "lib3mf/archive.h"

namespace vps::scenes::import {
namespace {

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
