// SPDX-License-Identifier: BSD-3-Clause
// Angles, points and names in sentences, beside the lengths and counts of number_words.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::scenes {

/// An angle in words: "1.2 degrees"
inline std::string degreesInWords(double angle_rad) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f degrees", angle_rad * 180 / std::numbers::pi);
  return text;
}

/// A point in words: "(1.00, 2.00, 3.00) mm"
inline std::string placeInWords(const Vec3& p_W) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f) mm", 1e3 * p_W.x(), 1e3 * p_W.y(), 1e3 * p_W.z());
  return text;
}

/// A name in quotes: "'a'"
inline std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

/// Names in a sentence: "'a', 'b' and 'c'"
/// @param most  greatest number of names; further names are counted: "'a', 'b' and 3 more"
inline std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + quoted(names[i]);
  return names.size() > most ? out + " and " + std::to_string(names.size() - most) + " more" : out;
}

}  // namespace vps::scenes
