// SPDX-License-Identifier: BSD-3-Clause
// The tolerance zones of ISO 286 for sizes up to 500 mm.
#pragma once

#include <optional>
#include <string>

namespace vps::scenes {

/// Least and greatest deviation from the nominal size [m].
struct Zone {
  double lower_m = 0, upper_m = 0;
};

/// "H7" (a hole), "g6" (a shaft): letters d to h, k, m, n, p for shafts and D to H for holes, grades 5 to 11.
/// Empty for other text, and outside of 0 to 500 mm.
std::optional<Zone> isoZone(const std::string& zone, double nominal_m);

/// The first of the fits that are commonly recommended, "H7/g6", in whose zones both diameters lie for a
/// nominal size that is a multiple of half a millimetre; empty if there is none.
std::string isoFit(double bore_m, double shaft_m);

}  // namespace vps::scenes
