// SPDX-License-Identifier: BSD-3-Clause
// Valid UTF-8 from the text of a file in any encoding.
#pragma once

#include <string>
#include <string_view>

namespace vps::scenes {

/// The text with U+FFFD in place of each byte that is not UTF-8 [RFC 3629]; TOML and JSON allow UTF-8 only.
std::string validUtf8(std::string_view text);

/// validUtf8() with a space in place of each control character.
std::string printable(std::string_view text);

}  // namespace vps::scenes
