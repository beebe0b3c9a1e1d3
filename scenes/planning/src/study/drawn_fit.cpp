// SPDX-License-Identifier: BSD-3-Clause
#include "study/drawn_fit.h"

#include <algorithm>

#include "check/check_placed.h"
#include "text/length_words.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {

namespace {

constexpr double kRounding_m =
    1e-9;  // assumed rounding of a fit's sizes, which are computed from doubles of metres

bool isMoved(const Scene& scene, const std::string& name) {
  return std::ranges::any_of(scene.steps,
                             [&](const SceneStep& step) { return scene.parts[step.part].part.name == name; });
}

bool mayOverlap(const CheckResult& checked, const CheckedFit& fit) {
  return std::ranges::any_of(checked.pairs, [&](const CheckedPair& pair) {
    const bool is_pair =
        (pair.a == fit.shaft && pair.b == fit.bore) || (pair.b == fit.shaft && pair.a == fit.bore);
    return is_pair && (pair.is_allowed || pair.press_fit_m > 0);
  });
}

DrawnMisfit ofPair(const Scene& scene, const CheckedPair& pair) {
  const bool is_a = isMoved(scene, pair.a);
  if (!pair.isClash() || (!is_a && !isMoved(scene, pair.b))) return {};
  const std::string& part = is_a ? pair.a : pair.b;
  const std::string& other = is_a ? pair.b : pair.a;
  return {part, other,
          std::string("it overlaps '")
              .append(other)
              .append("' by ")
              .append(lengthInWords(pair.interference_depth_m))
              .append(" (error ")
              .append(lengthInWords(pair.error_m))
              .append(")")};
}

DrawnMisfit ofFit(const Scene& scene, const CheckedFit& fit) {
  const bool is_shaft = isMoved(scene, fit.shaft);
  if (fit.kind == FitKind::Thread || (!is_shaft && !isMoved(scene, fit.bore))) return {};
  const double room_m = fit.diametral_clearance_m - 2 * fit.offset_m;
  if (room_m + fit.error_m >= -kRounding_m) return {};
  const std::string& part = is_shaft ? fit.shaft : fit.bore;
  return {part, is_shaft ? fit.bore : fit.shaft,
          std::string("'")
              .append(fit.shaft)
              .append("' is larger than the room in '")
              .append(fit.bore)
              .append("' by ")
              .append(lengthInWords(-room_m))};
}

}  // namespace

DrawnFit::DrawnFit(const Scene& scene) : parts_(drawnParts(scene)), placed_(placedSurfaces(parts_, {})) {}

CheckResult DrawnFit::check(const Scene& variant, const CheckSettings& settings) const {
  const std::vector<DrawnPart> parts = drawnParts(variant);
  return checkPlaced(variant.name, placedSurfaces(parts, {}, placed_), settings, {});
}

DrawnMisfit DrawnFit::findMisfit(const Scene& variant) const {
  CheckSettings settings;
  settings.has_play = false;
  for (const SceneStep& step : variant.steps)
    settings.only_parts.push_back(variant.parts[step.part].part.name);
  const CheckResult checked = check(variant, settings);
  for (const CheckedPair& pair : checked.pairs)
    if (DrawnMisfit found = ofPair(variant, pair); found.isFound()) return found;
  for (const CheckedFit& fit : checked.fits) {
    if (mayOverlap(checked, fit)) continue;
    if (DrawnMisfit found = ofFit(variant, fit); found.isFound()) return found;
  }
  return {};
}

}  // namespace vps::scenes
