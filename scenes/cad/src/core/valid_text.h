// SPDX-License-Identifier: BSD-3-Clause
// Text of files whose encoding nobody checked.
#pragma once

#include <string>
#include <string_view>

namespace vps::scenes {

/// The text with U+FFFD in place of each byte that is not UTF-8 [RFC 3629], as TOML and JSON have no others.
std::string validUtf8(std::string_view text);

/// The same with a space in place of each control character.
std::string printable(std::string_view text);

}  // namespace vps::scenes
