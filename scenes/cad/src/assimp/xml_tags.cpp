// SPDX-License-Identifier: BSD-3-Clause
#include "assimp/xml_tags.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

namespace vps::scenes::import {
namespace {

constexpr std::string_view kXmlBlank = " \t\r\n";

std::string_view withoutBlanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kXmlBlank), text.size()));
  return text.substr(0, text.find_last_not_of(kXmlBlank) + 1);
}

/// The position behind the '>' that ends a tag; a '>' within the value of an attribute does not end it.
std::size_t endOfTag(std::string_view xml, std::size_t at) {
  while ((at = xml.find_first_of(">\"'", at)) != std::string_view::npos && xml[at] != '>') {
    at = xml.find(xml[at], at + 1);
    if (at == std::string_view::npos) return at;
    ++at;
  }
  return at == std::string_view::npos ? at : at + 1;
}

/// The position behind the comment, unparsed text, instruction or declaration that begins at `at`; `at`
/// itself if none of these begins there.
std::size_t behindOther(std::string_view xml, std::size_t at) {
  const std::string_view text = xml.substr(at);
  const std::string_view end = text.starts_with("<!--")        ? "-->"
                               : text.starts_with("<![CDATA[") ? "]]>"
                               : text.starts_with("<?")        ? "?>"
                               : text.starts_with("<!")        ? ">"
                                                               : "";
  if (end.empty()) return at;
  const std::size_t found = xml.find(end, at);
  return found == std::string_view::npos ? xml.size() : found + end.size();
}

/// A character in UTF-8 [RFC 3629]; empty for a number that is not a character.
std::string utf8(std::uint32_t character) {
  const bool is_surrogate = character >= 0xD800 && character < 0xE000;
  if (character == 0 || is_surrogate || character > 0x10FFFF) return "";
  if (character < 0x80) return {static_cast<char>(character)};
  std::string text;
  int shift = character < 0x800 ? 6 : character < 0x10000 ? 12 : 18;
  text += static_cast<char>((shift == 6 ? 0xC0 : shift == 12 ? 0xE0 : 0xF0) | character >> shift);
  while ((shift -= 6) >= 0) text += static_cast<char>(0x80 | (character >> shift & 0x3F));
  return text;
}

std::string escaped(std::uint32_t character) {
  constexpr std::uint32_t kBlank = 0x20, kDelete = 0x7F;
  switch (character) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    default:
      return (character > 0 && character < kBlank) || character == kDelete ? " " : utf8(character);
  }
}

}  // namespace

std::optional<std::string_view> XmlTag::value(std::string_view key) const {
  std::string_view rest = withoutBlanks(attributes);
  while (true) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view name = withoutBlanks(rest.substr(0, equals));
    const std::size_t quote = rest.find_first_of("\"'", equals);
    if (quote == std::string_view::npos) return std::nullopt;
    const std::size_t close = rest.find(rest[quote], quote + 1);
    if (close == std::string_view::npos) return std::nullopt;
    if (name == key) return withoutBlanks(rest.substr(quote + 1, close - quote - 1));
    rest = withoutBlanks(rest.substr(close + 1));
  }
}

std::optional<XmlTag> nextTag(std::string_view xml, std::size_t& at) {
  while ((at = xml.find('<', at)) != std::string_view::npos) {
    if (const std::size_t behind = behindOther(xml, at); behind != at) {
      at = behind;
      continue;
    }
    XmlTag tag;
    tag.from = at;
    tag.end = at = endOfTag(xml, at);
    if (at == std::string_view::npos) return std::nullopt;
    std::string_view text = xml.substr(tag.from + 1, tag.end - tag.from - 2);
    const bool is_closing = text.starts_with('/'), is_empty = text.ends_with('/');
    tag.is_begin = !is_closing;
    tag.is_end = is_closing || is_empty;
    if (is_closing) text.remove_prefix(1);
    if (is_empty && !text.empty()) text.remove_suffix(1);
    const std::size_t stop = std::min(text.find_first_of(kXmlBlank), text.size());
    tag.name = text.substr(0, stop);
    tag.name.remove_prefix(tag.name.find(':') + 1);  // npos + 1 is 0
    tag.attributes = text.substr(stop);
    return tag;
  }
  return std::nullopt;
}

std::optional<XmlTag> tagAt(std::string_view xml, std::string_view path) {
  std::size_t at = 0;
  std::string open;
  while (const std::optional<XmlTag> tag = nextTag(xml, at)) {
    if (tag->is_begin) {
      open.append(open.empty() ? "" : "/").append(tag->name);
      if (open == path) return tag;
    }
    if (tag->is_end) open.resize(open.find('/') == std::string::npos ? 0 : open.rfind('/'));
  }
  return std::nullopt;
}

std::optional<std::string> withoutNumbersForCharacters(std::string_view xml) {
  std::string out;
  std::size_t copied = 0;
  for (std::size_t at = xml.find("&#"); at != std::string_view::npos; at = xml.find("&#", at + 1)) {
    const bool is_hex = xml.substr(at + 2).starts_with('x');
    const char *const from = xml.data() + at + (is_hex ? 3 : 2), *const end = xml.data() + xml.size();
    std::uint32_t character = 0;
    const auto [rest, error] = std::from_chars(from, end, character, is_hex ? 16 : 10);
    if (error != std::errc() || rest == end || *rest != ';') continue;
    const std::string text = escaped(character);
    if (text.empty()) continue;
    out.append(xml.substr(copied, at - copied)).append(text);
    copied = static_cast<std::size_t>(rest + 1 - xml.data());
  }
  if (copied == 0) return std::nullopt;
  return out.append(xml.substr(copied));
}

}  // namespace vps::scenes::import
