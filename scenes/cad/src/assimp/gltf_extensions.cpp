// SPDX-License-Identifier: BSD-3-Clause
#include "assimp/gltf_extensions.h"

#include <algorithm>
#include <array>

namespace vps::scenes::import {
namespace {

/// The '"' that ends a string of JSON which begins before `at`; the text's size if it is cut.
std::size_t endOfString(std::string_view json, std::size_t at) {
  while ((at = json.find_first_of("\"\\", at)) != std::string_view::npos && json[at] == '\\') at += 2;
  return std::min(at, json.size());
}

}  // namespace

std::vector<std::string> requiredExtensions(std::string_view json) {
  constexpr std::string_view kKey = "extensionsRequired";
  std::vector<std::string> names;
  bool is_key_last = false, is_in_list = false;  // the last string is the key; the list behind it is open
  std::size_t depth = 0;
  for (std::size_t at = 0; (at = json.find_first_of("\"{}[]", at)) < json.size(); ++at) {
    const char c = json[at];
    if (c == '"') {
      const std::size_t from = at + 1;
      at = endOfString(json, from);
      const std::string_view text = json.substr(from, at - from);
      if (is_in_list) names.emplace_back(text);
      is_key_last = depth == 1 && text == kKey;
    } else if (c == '{' || c == '[') {
      is_in_list = is_key_last && c == '[';
      is_key_last = false;
      ++depth;
    } else {
      is_in_list = false;
      depth -= depth > 0 ? 1 : 0;
    }
  }
  return names;
}

std::string unreadExtension(const std::vector<std::string>& names) {
  constexpr std::array<std::string_view, 6> kNoGeometry = {"_materials_", "_texture_",   "_lights_",
                                                           "_xmp",        "_animation_", "_image_"};
  const auto found = std::ranges::find_if(names, [&](const std::string& name) {
    return name != "KHR_draco_mesh_compression" &&
           std::ranges::none_of(kNoGeometry,
                                [&](std::string_view word) { return name.find(word) != std::string::npos; });
  });
  return found == names.end() ? "" : *found;
}

}  // namespace vps::scenes::import
