// SPDX-License-Identifier: BSD-3-Clause
// The tags of an XML text, for the few facts that the readers' libraries do not give.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vps::scenes::import {

struct XmlTag {
  std::string_view name;  ///< without a prefix of a namespace
  std::string_view attributes;
  std::size_t from = 0, end = 0;          ///< in the text, from '<' to after '>'
  bool is_begin = false, is_end = false;  ///< "<a/>" is both

  /// Without blanks around it; nothing if there is no such attribute. References to
  /// characters in it ("&lt;") are not replaced.
  [[nodiscard]] std::optional<std::string_view> value(std::string_view key) const;
};

/// The next tag from `at` on, which is moved behind it; comments, declarations and unparsed text are skipped.
std::optional<XmlTag> nextTag(std::string_view xml, std::size_t& at);

/// The first tag that begins an element at this path from the root, "COLLADA/asset/unit".
std::optional<XmlTag> tagAt(std::string_view xml, std::string_view path);

/// The text with each character in place of its number, "&#228;" and "&#xE4;": a name where it would be read
/// as markup ("&lt;"), and a blank for those of control. Nothing if the text has no such number.
std::optional<std::string> withoutNumbersForCharacters(std::string_view xml);

}  // namespace vps::scenes::import
