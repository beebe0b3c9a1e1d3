// SPDX-License-Identifier: BSD-3-Clause
// The tags of an XML text, for facts that assimp and lib3mf do not report.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vps::scenes::import {

struct XmlTag {
  std::string_view name;  ///< without the prefix of its namespace
  std::string_view attributes;
  std::size_t from = 0, end = 0;          ///< in the text, from '<' to after '>'
  bool is_begin = false, is_end = false;  ///< "<a/>" is both

  /// The value of an attribute without blanks around it; empty if the tag has no such attribute. References
  /// to characters ("&lt;") are not replaced.
  [[nodiscard]] std::optional<std::string_view> value(std::string_view key) const;
};

/// The next tag from position `at`, which is set to the position after the tag. Skips comments, declarations
/// and unparsed text.
std::optional<XmlTag> nextTag(std::string_view xml, std::size_t& at);

/// The first tag that begins an element at this path from the root, as in "COLLADA/asset/unit".
std::optional<XmlTag> tagAt(std::string_view xml, std::string_view path);

/// The text with characters in place of their numbers ("&#228;" and "&#xE4;"): a character of markup becomes
/// its name ("&lt;"), and a control character becomes a blank. Empty if the text has no such number.
std::optional<std::string> withoutNumbersForCharacters(std::string_view xml);

}  // namespace vps::scenes::import
