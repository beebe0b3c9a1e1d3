// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scene/scene_file_keys.h"
#include "vps/errors.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::scenes {
namespace {

/// The offset at which a line begins; lines count from 1. For a line beyond the last line, the offset is the
/// text's end.
std::size_t lineStart(const std::string& text, toml::source_index line) {
  std::size_t at = 0;
  for (; line > 1 && at != std::string::npos; --line) {
    at = text.find('\n', at);
    if (at != std::string::npos) ++at;
  }
  return std::min(at, text.size());
}

/// The offset of a position of toml++, which counts UTF-8 characters in a line, from 1.
std::size_t offsetOf(const std::string& text, const toml::source_position& place) {
  const auto isWithinCharacter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  std::size_t at = lineStart(text, place.line);
  for (toml::source_index column = place.column; column > 1 && at < text.size(); --column) do
      ++at;
    while (at < text.size() && isWithinCharacter(text[at]));
  return at;
}

std::string replaced(const std::string& text, const toml::node& old, const TomlValue& set) {
  const std::size_t begin = offsetOf(text, old.source().begin), end = offsetOf(text, old.source().end);
  return text.substr(0, begin) + set.value + text.substr(end);
}

std::string added(const std::string& text, const toml::table* table, const TomlValue& set) {
  const std::string newline = text.find("\r\n") != std::string::npos ? "\r\n" : "\n";
  const std::string line = set.key + " = " + set.value;
  if (!table) {
    const std::string gap = text.empty() ? "" : text.ends_with('\n') ? newline : newline + newline;
    return text + gap + "[" + set.table + "]" + newline + line + newline;
  }
  const toml::source_position& place = table->source().begin;
  std::size_t at = offsetOf(text, place);
  if (table->is_inline())
    return text.substr(0, at + 1) + line + (table->empty() ? "" : ", ") + text.substr(at + 1);
  if (at < text.size() && text[at] != '[') {  // a table of dotted keys; the first key is at `at`
    at = lineStart(text, place.line);
    return text.substr(0, at) + set.table + "." + line + newline + text.substr(at);
  }
  at = lineStart(text, place.line + 1);
  const bool is_last_line = at == text.size() && !text.ends_with('\n');
  return text.substr(0, at) + (is_last_line ? newline : "") + line + newline + text.substr(at);
}

/// A copy of `content` with the new value.
toml::table contentWith(toml::table content, const TomlValue& set) {
  const toml::table one = toml::parse(set.key + " = " + set.value);
  content.insert(set.table, toml::table());
  if (toml::table* table = content[set.table].as_table()) table->insert_or_assign(set.key, *one.get(set.key));
  return content;
}

std::string edited(const std::string& text, const std::string& file, const TomlValue& set) {
  const toml::table content = parseToml(text, file);
  const toml::table* table = content[set.table].as_table();
  const toml::node* old = table ? table->get(set.key) : nullptr;
  std::string out = old ? replaced(text, *old, set) : added(text, table, set);
  // A value in an unforeseen form is not edited.
  try {
    if (toml::parse(out) == contentWith(content, set)) return out;
  } catch (const toml::parse_error&) {  // a text that is not TOML is reported below
  }
  throw LoadError(file, "",
                  "has '" + set.key + "' of [" + set.table +
                      "] in a form that cannot be edited; write it in this form: " + set.key + " = " +
                      set.value);
}

}  // namespace

std::string editedToml(const std::string& file, std::span<const TomlValue> values) {
  std::string text = readTomlText(file, "TOML file", "scene.toml");
  for (const TomlValue& value : values) text = edited(text, file, value);
  return text;
}

}  // namespace vps::scenes
