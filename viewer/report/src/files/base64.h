// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace vps::viewer {

/// RFC 4648, section 4, with padding.
std::string base64(std::span<const std::byte> bytes);
/// The bytes of a PNG file as a data URL (RFC 2397), for a picture inside a page.
std::string pngInText(std::string_view bytes);

}  // namespace vps::viewer
