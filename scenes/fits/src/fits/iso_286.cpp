// SPDX-License-Identifier: BSD-3-Clause
#include "fits/iso_sizes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string_view>

namespace vps::scenes {

namespace {

constexpr std::size_t kRanges = 13;
using Row = std::array<int, kRanges>;  // um

// Upper ends of the ranges of nominal sizes [mm]; a size at the end of a range belongs to that range.
constexpr Row kUpTo_mm = {3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500};

// Standard tolerances IT5 to IT11 (ISO 286-1:2010, table 1). Above 3 mm, they are 7, 10, 16, 25, 40, 64 and
// 100 times i = 0.45 cbrt(D) + 0.001 D [um, mm] at the geometric mean D of a range's ends, rounded.
constexpr std::array<Row, 7> kTolerance = {{
    {4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27},
    {6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40},
    {10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63},
    {14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97},
    {25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155},
    {40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250},
    {60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400},
}};

// Fundamental deviations of shafts: the upper deviation of d to h, the lower deviation of k to p (ISO
// 286-1:2010, tables 2 to 5); the deviation of k is that of the grades 4 to 7. Formulas: d 16 D^0.44, e 11
// D^0.41, f 5.5 D^0.41, g 2.5 D^0.34, k 0.6 cbrt(D), m IT7 - IT6, n 5 D^0.34, p IT7 + 0 to 5.
struct Letter {
  char letter;
  Row deviation;
};
constexpr std::array<Letter, 9> kShafts = {{
    {'d', {-20, -30, -40, -50, -65, -80, -100, -120, -145, -170, -190, -210, -230}},
    {'e', {-14, -20, -25, -32, -40, -50, -60, -72, -85, -100, -110, -125, -135}},
    {'f', {-6, -10, -13, -16, -20, -25, -30, -36, -43, -50, -56, -62, -68}},
    {'g', {-2, -4, -5, -6, -7, -9, -10, -12, -14, -15, -17, -18, -20}},
    {'h', {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {'k', {0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5}},
    {'m', {2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23}},
    {'n', {4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40}},
    {'p', {6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68}},
}};

// The fits that ISO 286-1:2010, annex B recommends: first hole-basis fits, then shaft-basis fits, and finer
// fits before coarser fits.
constexpr std::array kFits = {"H6/h5", "H7/h6", "H7/g6", "H7/k6", "H7/m6",  "H7/n6",   "H7/p6",  "H8/h7",
                              "H7/f7", "H8/f7", "H8/e8", "G7/h6", "F8/h6",  "H9/h9",   "H8/d9",  "F8/h9",
                              "E8/h9", "H9/e9", "H9/d9", "D9/h9", "H11/h9", "H11/h11", "D10/h9", "H11/d11"};

}  // namespace

std::optional<Zone> isoZone(const std::string& zone, double nominal_m) {
  const double nominal_mm = 1e3 * nominal_m;
  if (zone.size() < 2 || !(nominal_mm > 0) || nominal_mm > kUpTo_mm.back()) return std::nullopt;
  const auto range = static_cast<std::size_t>(
      std::distance(kUpTo_mm.begin(), std::lower_bound(kUpTo_mm.begin(), kUpTo_mm.end(), nominal_mm - 1e-9)));
  const int grade = std::atoi(zone.c_str() + 1);
  const bool is_hole = std::isupper(static_cast<unsigned char>(zone[0])) != 0;
  const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(zone[0])));
  const auto row =
      std::find_if(kShafts.begin(), kShafts.end(), [&](const Letter& l) { return l.letter == letter; });
  if (grade < 5 || grade > 11 || row == kShafts.end()) return std::nullopt;
  if (is_hole && letter > 'h')
    return std::nullopt;  // holes K, M, N and P need corrections that depend on the grade
  const double width_m = 1e-6 * kTolerance[static_cast<std::size_t>(grade - 5)][range];
  const double deviation_m = 1e-6 * row->deviation[range];
  if (letter > 'h') return Zone{deviation_m, deviation_m + width_m};
  return is_hole ? Zone{-deviation_m, -deviation_m + width_m} : Zone{deviation_m - width_m, deviation_m};
}

std::string isoFit(double bore_m, double shaft_m) {
  constexpr double kStep_m = 0.5e-3;
  // A deviation below 0.01 um is rounding of the mesh's coordinates.
  constexpr double kRound_m = 0.01e-6;
  const auto lies = [](const std::optional<Zone>& zone, double deviation_m) {
    return zone && deviation_m >= zone->lower_m - kRound_m && deviation_m <= zone->upper_m + kRound_m;
  };
  const double nominal_m = kStep_m * std::round(0.5 * (bore_m + shaft_m) / kStep_m);
  for (const std::string_view fit : kFits) {
    const std::size_t slash = fit.find('/');
    if (lies(isoZone(std::string(fit.substr(0, slash)), nominal_m), bore_m - nominal_m) &&
        lies(isoZone(std::string(fit.substr(slash + 1)), nominal_m), shaft_m - nominal_m))
      return std::string(fit);
  }
  return "";
}

}  // namespace vps::scenes
