// SPDX-License-Identifier: BSD-3-Clause
#include "lib3mf/model_faults.h"

#include <charconv>
#include <string_view>

#include "assimp/xml_tags.h"
#include "core/valid_text.h"
#include "lib3mf/archive.h"

namespace vps::scenes::import {
namespace {

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

}  // namespace

std::string modelFault(const std::string& archive) {
  std::string fault;
  forEachFile(archive, kWholeFile, [&](std::string_view name, const std::string& text) {
    if (isModel(name) && !text.empty()) fault = faultOf(text);
    if (!fault.empty()) fault = std::string(name) + " " + fault;
    return fault.empty();
  });
  return fault;
}

}  // namespace vps::scenes::import
