// SPDX-License-Identifier: BSD-3-Clause
// Numbers in sentences: lengths with a unit that suits them, and counts of things.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

namespace vps::scenes {

/// A length in words: "12.3 um" below a millimetre, "1.23 mm" below a metre, "1.23 m" above.
/// @param digits  digits after the decimal point of a length in um; millimetres and metres get one digit more
inline std::string lengthInWords(double length_m, int digits = 1) {
  struct Unit {
    double per_m;
    const char* name;
    int digits;
  };
  const std::array<Unit, 3> units = {{{1e6, "um", digits}, {1e3, "mm", digits + 1}, {1, "m", digits + 1}}};
  std::array<char, 64> text{};
  for (const Unit& unit : units) {
    // 999.99 um at one digit is written as 1.00 mm, because it would be rounded to 1000.0 um.
    const double rounding = 0.5 * std::pow(10.0, -unit.digits);
    if (unit.per_m > 1 && std::abs(unit.per_m * length_m) + rounding >= 1000) continue;
    std::snprintf(text.data(), text.size(), "%.*f %s", unit.digits, unit.per_m * length_m, unit.name);
    break;
  }
  return text.data();
}

/// A number of things: "1 part", "3 parts".
/// @param many  the word for several things; empty: the word for one with an s
inline std::string counted(std::size_t count, const std::string& one, const std::string& many = {}) {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace vps::scenes
