// SPDX-License-Identifier: BSD-3-Clause
// Bytes as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace vps::viewer::inline v0 {

/// RFC 4648, section 4, with padding.
std::string base64(std::span<const std::byte> bytes);

}  // namespace vps::viewer::inline v0
