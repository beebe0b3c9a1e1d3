// SPDX-License-Identifier: BSD-3-Clause
#include "world/displaced_mates.h"

#include <algorithm>
#include <string>
#include <utility>

#include "scene/parts_in_place.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

constexpr double kSame_m = 1e-9;  // far below what a part's place is known to

/// The part of a mate's displacement that a fit passes on: a shaft none along its axis, a key only across its
/// faces.
Vec3 passedOn(const CheckedFit& fit, const Vec3& by_m) {
  const Vec3 along_axis_m = fit.axis_W * fit.axis_W.dot(by_m);
  if (fit.kind == FitKind::Shaft) return by_m - along_axis_m;
  return fit.kind == FitKind::Key ? along_axis_m : by_m;
}

}  // namespace

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
