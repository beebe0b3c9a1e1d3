// SPDX-License-Identifier: BSD-3-Clause
#include "fits/iso_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace vps::scenes {

namespace {

/// A nominal size with its coarse pitch and its fine pitches [mm].
struct Size {
  double nominal, coarse;
  std::array<double, 3> fine = {};
};
/// The hole of a thread drawn as a plain hole is below the nominal size by 1 to 1.0825 pitches, within 0.1.
constexpr double kMostBelow = 1.0825, kLeastBelow = 1, kBelowSlack = 0.1;
constexpr std::array kSizes = {Size{1, 0.25},
                               Size{1.2, 0.25},
                               Size{1.4, 0.3},
                               Size{1.6, 0.35},
                               Size{1.8, 0.35},
                               Size{2, 0.4},
                               Size{2.5, 0.45},
                               Size{3, 0.5},
                               Size{3.5, 0.6},
                               Size{4, 0.7},
                               Size{5, 0.8},
                               Size{6, 1},
                               Size{7, 1},
                               Size{8, 1.25, {1}},
                               Size{10, 1.5, {1.25, 1}},
                               Size{12, 1.75, {1.5, 1.25}},
                               Size{14, 2, {1.5}},
                               Size{16, 2, {1.5}},
                               Size{18, 2.5, {2, 1.5}},
                               Size{20, 2.5, {2, 1.5}},
                               Size{22, 2.5, {2, 1.5}},
                               Size{24, 3, {2}},
                               Size{27, 3, {2}},
                               Size{30, 3.5, {2}},
                               Size{33, 3.5, {2}},
                               Size{36, 4, {3}},
                               Size{39, 4, {3}},
                               Size{42, 4.5, {3}},
                               Size{45, 4.5, {3}},
                               Size{48, 5, {3}},
                               Size{52, 5, {4}},
                               Size{56, 5.5, {4}},
                               Size{60, 5.5, {4}},
                               Size{64, 6, {4}}};

/// Lower deviation of the major diameter at 8g [mm]: es of g is -(15 + 11 P) um, and grade 8 is 1.6 times
/// grade 6, 180 P^(2/3) - 3.15 / sqrt(P) um.
double lowest_mm(double pitch_mm) {
  return -1e-3 *
         (15 + 11 * pitch_mm + 1.6 * (180 * std::cbrt(pitch_mm * pitch_mm) - 3.15 / std::sqrt(pitch_mm)));
}

std::string nameOf(double nominal_mm, double pitch_mm, bool is_coarse, bool is_left) {
  char text[48];
  int n = std::snprintf(text, sizeof text, "M%g", nominal_mm);
  if (!is_coarse) n += std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "x%g", pitch_mm);
  if (is_left) std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "-LH");
  return text;
}

}  // namespace

MetricThread metricThread(double major_m, double lead_m) {
  constexpr double kSamePitch = 0.01;
  constexpr double kAbove_mm = 1e-3;  // excess over the nominal size by rounding in the drawing
  const double pitch_mm = 1e3 * std::abs(lead_m), major_mm = 1e3 * major_m;
  for (const Size& size : kSizes) {
    const double above_mm = major_mm - size.nominal;
    const auto is = [&](double standard_mm) {
      return standard_mm > 0 && std::abs(pitch_mm - standard_mm) <= kSamePitch * standard_mm &&
             above_mm <= kAbove_mm && above_mm >= lowest_mm(standard_mm);
    };
    if (is(size.coarse)) return {nameOf(size.nominal, size.coarse, true, lead_m < 0), 1e-3 * size.coarse};
    for (const double fine_mm : size.fine)
      if (is(fine_mm)) return {nameOf(size.nominal, fine_mm, false, lead_m < 0), 1e-3 * fine_mm};
  }
  return {};
}

std::string metricSize(double major_m) {
  constexpr double kAbove_mm = 1e-3;
  for (const Size& size : kSizes) {
    const double above_mm = 1e3 * major_m - size.nominal;
    if (above_mm <= kAbove_mm && above_mm >= lowest_mm(size.coarse))
      return nameOf(size.nominal, size.coarse, true, false);
  }
  return "";
}

namespace {

/// Whether a hole has the minor diameter of a nut, D - 1.0825 P, or the diameter of its drill, D - P.
bool isMinor(double hole_mm, double nominal_mm, double pitch_mm) {
  const double below = (nominal_mm - hole_mm) / pitch_mm;
  return pitch_mm > 0 && below < kMostBelow + kBelowSlack && below > kLeastBelow - kBelowSlack;
}

}  // namespace

std::string metricHole(double minor_m) {
  const double hole_mm = 1e3 * minor_m;
  for (const Size& size : kSizes)
    if (isMinor(hole_mm, size.nominal, size.coarse)) return nameOf(size.nominal, size.coarse, true, false);
  for (const Size& size : kSizes)
    for (const double fine_mm : size.fine)
      if (isMinor(hole_mm, size.nominal, fine_mm)) return nameOf(size.nominal, fine_mm, false, false);
  return "";
}

std::string metricNut(double hole_m, double across_m) {
  struct Nut {
    double nominal;
    std::array<double, 2> across;  ///< widths across flats [mm]; 0: none
  };
  constexpr std::array kNuts = {
      Nut{1.6, {3.2}},   Nut{2, {4}},   Nut{2.5, {5}}, Nut{3, {5.5}}, Nut{3.5, {6}},     Nut{4, {7}},
      Nut{5, {8}},       Nut{6, {10}},  Nut{7, {11}},  Nut{8, {13}},  Nut{10, {16, 17}}, Nut{12, {18, 19}},
      Nut{14, {21, 22}}, Nut{16, {24}}, Nut{18, {27}}, Nut{20, {30}}, Nut{22, {34, 32}}, Nut{24, {36}},
      Nut{27, {41}},     Nut{30, {46}}, Nut{33, {50}}, Nut{36, {55}}, Nut{39, {60}},     Nut{42, {65}},
      Nut{45, {70}},     Nut{48, {75}}, Nut{52, {80}}, Nut{56, {85}}, Nut{60, {90}},     Nut{64, {95}}};
  // Product grades A to C let a nut be narrower by up to 3 %.
  constexpr double kNarrower = 0.03, kWider = 0.002;
  const double hole_mm = 1e3 * hole_m, across_mm = 1e3 * across_m;
  for (const Size& size : kSizes) {
    const auto nut = std::ranges::find(kNuts, size.nominal, &Nut::nominal);
    if (nut == kNuts.end()) continue;
    const bool is_width = std::ranges::any_of(nut->across, [&](double standard_mm) {
      return standard_mm > 0 && across_mm > (1 - kNarrower) * standard_mm &&
             across_mm < (1 + kWider) * standard_mm;
    });
    if (!is_width) continue;
    // A hole drawn with the major diameter may have the clearance of a tapped hole's root.
    constexpr double kRoot = 0.1;  // of the pitch
    const auto isMajor = [&](double pitch_mm) {
      return pitch_mm > 0 && std::abs(hole_mm - size.nominal) < kRoot * pitch_mm;
    };
    if (isMajor(size.coarse) || isMinor(hole_mm, size.nominal, size.coarse))
      return nameOf(size.nominal, size.coarse, true, false);
    for (const double fine_mm : size.fine)
      if (isMinor(hole_mm, size.nominal, fine_mm)) return nameOf(size.nominal, fine_mm, false, false);
  }
  return "";
}

std::string metricThreadIn(double shaft_m, double hole_m) {
  constexpr double kAbove_mm = 1e-3;
  for (const Size& size : kSizes) {
    const double above_mm = 1e3 * shaft_m - size.nominal;
    if (above_mm > kAbove_mm || above_mm < lowest_mm(size.coarse)) continue;
    double least = kBelowSlack;
    std::string name;
    for (const double pitch_mm : {size.coarse, size.fine[0], size.fine[1], size.fine[2]}) {
      if (!(pitch_mm > 0)) continue;
      const double below = (size.nominal - 1e3 * hole_m) / pitch_mm;
      const double off = std::max({kLeastBelow - below, below - kMostBelow, 0.0});
      if (off >= least) continue;
      least = off;
      name = nameOf(size.nominal, pitch_mm, pitch_mm == size.coarse, false);
    }
    if (!name.empty()) return name;
  }
  return "";
}

}  // namespace vps::scenes
