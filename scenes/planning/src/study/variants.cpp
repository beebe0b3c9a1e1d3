// SPDX-License-Identifier: BSD-3-Clause
#include "study/variants.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "check/check_placed.h"
#include "models/scene_models.h"
#include "proof/places.h"
#include "scene/steps.h"
#include "text/words.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/run/verdict.h"

namespace vps::scenes {

namespace {

/// Applies a change to every pose of the step's part, from start to target.
template <class Change>
void changePath(SceneStep& step, Change change) {
  change(step.X_WP_start);
  for (Pose& X_WP : step.way_points) change(X_WP);
  change(step.X_WP_target);
}

/// A part in place, as drawn and with its deviation.
struct Placed {
  Pose X_WP_drawn, X_WP;
  double growth_m = 0, turn_rad = 0;
};

/// Rise of the highest of the parts in place near the point p_W, against the axis, compared with the drawing.
/// A tilt lifts a part of radius_m at one edge.
double seatRise(const std::vector<Placed>& in_place, const Vec3& p_W, const Vec3& axis_W, double radius_m) {
  if (in_place.empty() || axis_W.isZero()) return 0;
  double rise_m = -std::numeric_limits<double>::infinity();
  for (const Placed& part : in_place) {
    const Vec3 move_W = part.X_WP * (part.X_WP_drawn.inverse() * p_W) - p_W;
    rise_m = std::max(rise_m, part.growth_m + part.turn_rad * radius_m - move_W.dot(axis_W));
  }
  return rise_m;
}

}  // namespace

void growPart(ScenePart& part, double by_m) {
  if (by_m == 0) return;
  part.part.mesh = shrunkMesh(part.part.mesh, -by_m);
  part.model.reset();
  part.is_cropped = false;
}

Scene withGrownStep(const Scene& scene, std::size_t step, double by_m) {
  Scene grown = scene;
  SceneStep& of = grown.steps[step];
  growPart(grown.parts[of.part], by_m);
  const Vec3 back_W = -by_m * insertionAxis(of, Pose());
  changePath(of, [&](Pose& X_WP) { X_WP.p += back_W; });
  return grown;
}

Pose PartDeviation::X_PE() const {
  return {rotationFromVector(turn_P_rad), move_P_m};
}

Scene withDeviations(const Scene& scene, const std::vector<PartDeviation>& deviations) {
  Scene varied = scene;
  std::vector<Placed> in_place;
  for (std::size_t i = 0; i < varied.parts.size(); ++i) {
    ScenePart& part = varied.parts[i];
    const PartDeviation& by = deviations[i];
    growPart(part, by.growth_m);
    part.part.material.friction = std::max(0.0, part.part.material.friction + by.friction);
    if (!part.is_fixed) continue;
    const Pose X_WP_drawn = part.X_WP;
    if (by.isDisplaced()) part.X_WP = part.X_WP * by.X_PE();
    in_place.push_back({X_WP_drawn, part.X_WP, by.growth_m, by.turn_P_rad.norm()});
  }
  for (SceneStep& step : varied.steps) {
    const PartDeviation& by = deviations[step.part];
    const Vec3 axis_W = insertionAxis(step, Pose());
    const double radius_m = 0.5 * bounds(scene.parts[step.part].part.mesh).size().norm();
    const Pose X_WP_drawn = step.X_WP_target;
    const double rise_m =
        by.growth_m + by.turn_P_rad.norm() * radius_m + seatRise(in_place, X_WP_drawn.p, axis_W, radius_m);
    const Vec3 across_m = X_WP_drawn.R * by.move_P_m;
    const Vec3 move_W = across_m - across_m.dot(axis_W) * axis_W - rise_m * axis_W;
    changePath(step, [&](Pose& X_WP) {
      if (!by.turn_P_rad.isZero()) X_WP.R = X_WP.R * rotationFromVector(by.turn_P_rad);
      X_WP.p += move_W;
    });
    in_place.push_back({X_WP_drawn, step.X_WP_target, by.growth_m, by.turn_P_rad.norm()});
  }
  return varied;
}

Scene excerptOf(const Scene& scene, std::size_t step) {
  Scene excerpt = scene;
  const std::size_t moving = scene.steps[step].part;
  for (std::size_t i = 0; i < step; ++i) {
    ScenePart& mounted = excerpt.parts[scene.steps[i].part];
    mounted.is_fixed = true;
    mounted.X_WP = scene.steps[i].X_WP_target;
  }
  std::vector<ScenePart> kept;
  excerpt.steps = {scene.steps[step]};
  for (std::size_t i = 0; i < excerpt.parts.size(); ++i) {
    if (i == moving) excerpt.steps[0].part = kept.size();
    if (i == moving || excerpt.parts[i].is_fixed) kept.push_back(excerpt.parts[i]);
  }
  excerpt.parts = std::move(kept);
  excerpt.hand.seed += step;  // each step of a procedure has its own seed
  return excerpt;
}

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

DrawnMisfit ofPair(const Scene& scene, const CheckedPair& pair, const CheckedPlaces& places) {
  const bool is_a = isMoved(scene, pair.a);
  if (!pair.isClash() || (!is_a && !isMoved(scene, pair.b))) return {};
  const std::string& part = is_a ? pair.a : pair.b;
  const std::string& other = is_a ? pair.b : pair.a;
  const Judgement found = judgeOverlap(places, part);
  if (isGood(found.verdict)) return {};
  return {found.verdict, part, other,
          overlapReason(other, pair.interference_depth_m, pair.error_m, pair.at_W) + "; " + found.reason};
}

/// @param room_m  diametral clearance of the shaft, less what the check does not assume to be corrected
DrawnMisfit ofFit(const Scene& scene, const CheckedFit& fit, double room_m, Verdict verdict) {
  const bool is_shaft = isMoved(scene, fit.shaft);
  if (fit.kind == FitKind::Thread || (!is_shaft && !isMoved(scene, fit.bore))) return {};
  if (room_m + fit.error_m >= -kRounding_m) return {};
  std::string reason =
      "'" + fit.shaft + "' is larger than the room in '" + fit.bore + "' by " + lengthInWords(-room_m);
  if (verdict == Verdict::NotShown)
    reason += " because their axes are drawn apart, and nothing shows places at which they are not";
  return {verdict, is_shaft ? fit.shaft : fit.bore, is_shaft ? fit.bore : fit.shaft, std::move(reason)};
}

bool isFreed(const CheckedPlaces& places, const CheckedFit& fit) {
  return std::ranges::any_of(
      places.moved, [&](const MovedPart& part) { return part.name == fit.shaft || part.name == fit.bore; });
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
  const std::vector<DrawnPart> parts = drawnParts(variant);
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {}, placed_);
  const CheckResult checked = checkPlaced(variant.name, placed, settings, {});
  std::vector<const CheckedFit*> fits;
  for (const CheckedFit& fit : checked.fits)
    if (!mayOverlap(checked, fit)) fits.push_back(&fit);
  for (const CheckedFit* fit : fits)
    if (DrawnMisfit found = ofFit(variant, *fit, fit->diametral_clearance_m, Verdict::Blocked);
        found.isFound())
      return found;
  // All pairs that contain a moved part were measured, and no other part moves. Scenery takes no part in a
  // run, so that places that are found with it say nothing.
  const bool has_scenery = std::ranges::any_of(variant.parts, &ScenePart::is_scenery);
  const CheckedPlaces places = has_scenery ? checked.places : freePlaces(placed, checked, {});
  DrawnMisfit open;
  for (const CheckedPair& pair : checked.pairs) {
    DrawnMisfit found = ofPair(variant, pair, places);
    if (found.verdict == Verdict::Blocked) return found;
    if (!open.isFound()) open = std::move(found);
  }
  for (const CheckedFit* fit : fits) {
    if (open.isFound()) break;
    if (!isFreed(places, *fit))
      open = ofFit(variant, *fit, fit->diametral_clearance_m - 2 * fit->offset_m, Verdict::NotShown);
  }
  return open;
}

}  // namespace vps::scenes
