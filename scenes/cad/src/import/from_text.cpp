// SPDX-License-Identifier: BSD-3-Clause
// Lengths, angles, units and axes from text.
#include <charconv>
#include <cmath>
#include <numbers>

#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {

std::optional<double> unitFromText(const std::string& text) {
  if (text == "m") return 1.0;
  if (text == "cm") return 1e-2;
  if (text == "mm") return 1e-3;
  if (text == "um") return 1e-6;
  if (text == "inch") return 25.4e-3;
  return std::nullopt;
}

double lengthFromText(const std::string& text, const std::string& what) {
  const std::string remedy = "write a length with its unit, like 0.2mm, 20um or 0.01m (mm, cm, m, um, inch)";
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);  // independent of the locale
  if (error != std::errc() || !std::isfinite(value)) {
    throw LoadError(what, "", "'" + text + "' is not a length; " + remedy);
  }
  std::string unit(rest, end);
  unit.erase(0, unit.find_first_not_of(' '));
  const std::optional<double> unit_m = unitFromText(unit);
  if (!unit_m && unit.empty()) throw LoadError(what, "", "'" + text + "' has no unit; " + remedy);
  if (!unit_m) throw LoadError(what, "", "'" + text + "' has the unknown unit '" + unit + "'; " + remedy);
  return value * *unit_m;
}

double angleFromText(const std::string& text, const std::string& what) {
  const std::string remedy = "write an angle with its unit, like 2deg or 0.01rad";
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || !std::isfinite(value))
    throw LoadError(what, "", "'" + text + "' is not an angle; " + remedy);
  std::string unit(rest, end);
  unit.erase(0, unit.find_first_not_of(' '));
  if (unit == "rad") return value;
  if (unit == "deg") return value * std::numbers::pi / 180;
  throw LoadError(
      what, "",
      "'" + text + (unit.empty() ? "' has no unit; " : "' has the unknown unit '" + unit + "'; ") + remedy);
}

std::optional<Vec3> axisFromText(const std::string& text) {
  const bool is_negative = text.starts_with("-");
  const std::string name = text.substr(is_negative ? 1 : 0);
  if (name.size() != 1 || name < "x" || name > "z") return std::nullopt;
  return Vec3((is_negative ? -1 : 1) * Vec3::Unit(name[0] - 'x'));
}

}  // namespace vps::scenes
