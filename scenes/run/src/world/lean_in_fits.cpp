// SPDX-License-Identifier: BSD-3-Clause
#include "world/lean_in_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/parts_in_place.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

/// Fits of one direction.
struct Guide {
  Vec3 axis_W = Vec3::UnitZ();
  double from_m = 0, to_m = 0;  ///< along the axis
  double clearance_m = 0;       ///< least
  Vec3 at_W = Vec3::Zero();     ///< of the first fit
};

std::vector<Guide> guidesOf(const std::vector<CheckedFit>& fits, const std::string& part) {
  constexpr double kParallel = 0.9998;  // 1 degree
  std::vector<Guide> guides;
  for (const CheckedFit& fit : fits) {
    if (fit.shaft != part && fit.bore != part) continue;
    const double clearance_m = std::max(0.0, fit.diametral_clearance_m);
    const auto at = std::ranges::find_if(
        guides, [&](const Guide& guide) { return std::abs(guide.axis_W.dot(fit.axis_W)) > kParallel; });
    Guide& guide =
        at != guides.end() ? *at : guides.emplace_back(Guide{fit.axis_W, 0, 0, clearance_m, fit.at_W});
    const double mid_m = guide.axis_W.dot(fit.at_W - guide.at_W);
    guide.from_m = std::min(guide.from_m, mid_m - fit.length_m / 2);
    guide.to_m = std::max(guide.to_m, mid_m + fit.length_m / 2);
    guide.clearance_m = std::min(guide.clearance_m, clearance_m);
  }
  return guides;
}

}  // namespace

double leanInFits_m(const DrawnPart& part, const std::vector<DrawnPart>& others) {
  std::vector<DrawnPart> parts = others;
  parts.push_back(part);
  CheckSettings settings;
  settings.has_play = false;
  settings.only_parts = {part.name};
  const CheckResult checked = checkAssembly("lean", parts, settings);
  std::optional<double> least_m;
  for (const Guide& guide : guidesOf(checked.fits, part.name)) {
    const double length_m = guide.to_m - guide.from_m;
    if (length_m <= 0) continue;
    const Vec3 middle_W = guide.at_W + 0.5 * (guide.from_m + guide.to_m) * guide.axis_W;
    double reach_m = 0;
    for (const Vec3& p : part.mesh.vertices) reach_m = std::max(reach_m, (part.X_WP * p - middle_W).norm());
    const double lean_m = guide.clearance_m * std::max(0.5, reach_m / length_m);
    least_m = std::min(least_m.value_or(lean_m), lean_m);
  }
  return least_m.value_or(0);
}

double leanInFits_m(const Scene& scene, std::size_t step) {
  std::vector<DrawnPart> parts = drawnParts(scene);
  const SceneStep& planned = scene.steps[step];
  DrawnPart own = parts[planned.part];
  own.X_WP = planned.X_WP_target;
  std::vector<DrawnPart> others;
  for (const PartInPlace& other : partsInPlace(scene, step)) {
    others.push_back(std::move(parts[other.part]));
    others.back().X_WP = other.X_WP;
  }
  return leanInFits_m(own, others);
}

}  // namespace vps::scenes
