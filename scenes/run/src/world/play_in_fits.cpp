// SPDX-License-Identifier: BSD-3-Clause
#include "world/play_in_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "scene/steps.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

/// All fits of a part with the same direction.
struct Guide {
  Vec3 axis_W = Vec3::UnitZ();
  double from_m = 0, to_m = 0;  ///< ends along the axis, from at_W
  double clearance_m = 0;       ///< least clearance of the fits
  Vec3 at_W = Vec3::Zero();     ///< middle of the first fit
};

std::vector<Guide> guidesOf(const std::vector<CheckedFit>& fits, const std::string& part) {
  constexpr double kParallel = 0.9998;  // cosine of 1 degree, within which fits are parallel
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

// Displacements that differ by less are equal; the limit is far below the accuracy of a part's pose.
constexpr double kSame_m = 1e-9;
Vec3 passedOn(const CheckedFit& fit, const Vec3& by_m) {
  const Vec3 along_axis_m = fit.axis_W * fit.axis_W.dot(by_m);
  if (fit.kind == FitKind::Shaft) return by_m - along_axis_m;
  return fit.kind == FitKind::Key ? along_axis_m : by_m;
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

std::vector<Vec3> displacedMates_m(const Scene& scene, std::size_t step, const std::vector<Pose>& X_WP) {
  const std::vector<DrawnPart> drawn = drawnParts(scene);
  const SceneStep& planned = scene.steps[step];
  CheckSettings settings;
  settings.has_play = false;
  settings.only_parts = {drawn[planned.part].name};
  std::vector<DrawnPart> parts = {drawn[planned.part]};
  parts.front().X_WP = planned.X_WP_target;
  const std::vector<PartInPlace> in_place = partsInPlace(scene, step);
  for (const PartInPlace& other : in_place) {
    parts.push_back(drawn[other.part]);
    parts.back().X_WP = other.X_WP;
  }
  std::vector<Vec3> displaced_m;
  for (const CheckedFit& fit : checkAssembly("mates", parts, settings).fits) {
    const std::string& mate = fit.shaft == parts.front().name ? fit.bore : fit.shaft;
    const auto at =
        std::ranges::find(in_place, mate, [&](const PartInPlace& other) { return drawn[other.part].name; });
    if (at == in_place.end() || scene.parts[at->part].is_fixed) continue;
    const Vec3 by_m = X_WP[at->part] * (at->X_WP.inverse() * fit.at_W) - fit.at_W;
    const Vec3 passed_on_m = passedOn(fit, by_m);
    displaced_m.push_back(passed_on_m);
    if ((by_m - passed_on_m).norm() > kSame_m) displaced_m.push_back(by_m);
  }
  return displaced_m;
}

}  // namespace vps::scenes
