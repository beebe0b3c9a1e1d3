// SPDX-License-Identifier: BSD-3-Clause
#include "text/length_words.h"

#include <cstdio>
#include <numbers>

namespace vps::scenes {

std::string lengthInWords(double length_m) {
  char text[64];
  if (length_m < 1e-3)
    std::snprintf(text, sizeof text, "%.1f um", 1e6 * length_m);
  else if (length_m < 1)
    std::snprintf(text, sizeof text, "%.2f mm", 1e3 * length_m);
  else
    std::snprintf(text, sizeof text, "%.2f m", length_m);
  return text;
}

std::string degreesInWords(double angle_rad) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f degrees", angle_rad * 180 / std::numbers::pi);
  return text;
}

std::string placeInWords(const Vec3& p_W) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f) mm", 1e3 * p_W.x(), 1e3 * p_W.y(), 1e3 * p_W.z());
  return text;
}

}  // namespace vps::scenes
