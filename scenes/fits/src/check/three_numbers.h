// SPDX-License-Identifier: BSD-3-Clause
// Directions from text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

#include "vps/pose.h"

namespace vps::scenes {

/// The three numbers of "0:0.7:0.7"; empty for other text. They may be of any length, not finite, or all
/// zero.
inline std::optional<Vec3> threeNumbers(std::string_view text) {
  Vec3 out = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), out[i]);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    if (i == 2) break;
    if (!text.starts_with(':')) return std::nullopt;
    text.remove_prefix(1);
  }
  if (!text.empty()) return std::nullopt;
  return out;
}

}  // namespace vps::scenes
