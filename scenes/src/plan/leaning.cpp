// SPDX-License-Identifier: BSD-3-Clause
#include "plan/leaning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vps::scenes::inline v0 {

bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held) {
  constexpr double kLevel = 0.5, kParallel = 0.999;  // of the axes: less than 30 degrees up, and the same one
  const PlacedSurface& placed = motions.parts()[part];
  const Vec3& up_W = motions.directions()[motions.up()];
  const auto isHeld = [&](const std::string& name) {
    return std::ranges::any_of(held, [&](std::size_t h) { return motions.parts()[h].name == name; });
  };
  std::vector<std::string> holes;
  double from_m = std::numeric_limits<double>::infinity(), to_m = -from_m;
  Vec3 axis_W = Vec3::Zero();
  for (const CheckedFit& fit : motions.fitsOf(part)) {
    if (fit.kind == FitKind::Key || fit.shaft != placed.name || !isHeld(fit.bore)) continue;
    if (std::abs(fit.axis_W.dot(up_W)) > kLevel) return false;
    if (axis_W.isZero()) axis_W = fit.axis_W;
    if (std::abs(fit.axis_W.dot(axis_W)) < kParallel) return false;
    const double middle_m = axis_W.dot(fit.at_W);
    from_m = std::min(from_m, middle_m - 0.5 * fit.length_m);
    to_m = std::max(to_m, middle_m + 0.5 * fit.length_m);
    holes.push_back(fit.bore);
  }
  const bool has_other = std::ranges::any_of(motions.carriersOf(part), [&](std::size_t carrier) {
    const std::string& name = motions.parts()[carrier].name;
    return isHeld(name) && std::ranges::find(holes, name) == holes.end();
  });
  if (holes.empty() || has_other) return false;
  const double center_m = axis_W.dot(placed.X_WP * massProperties(placed.surface->mesh()).com);
  return center_m < from_m || center_m > to_m;
}

}  // namespace vps::scenes::inline v0
