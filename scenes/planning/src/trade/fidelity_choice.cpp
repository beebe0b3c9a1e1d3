// SPDX-License-Identifier: BSD-3-Clause
// Search for a fidelity that keeps given bounds, and its description in words.
#include "vps_scenes/planning/fidelity_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/machine.h"
#include "models/scene_models.h"
#include "scene/steps.h"
#include "trade/samples.h"
#include "vps/errors.h"
#include "vps/solid.h"
#include "vps/voxmap.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

constexpr double kCoarsest_m = 2e-3, kFinest_m = 15e-6;
constexpr double kStep = 0.70710678118654752;  ///< ratio of successive voxel sizes
constexpr std::size_t kSamples = 2000;         ///< number of sample points per part
constexpr double kShare = 0.95;                ///< share of the sample points that do not exceed the error
/// Share of the tolerance that the errors at the sample points keep, so that other points keep the whole
/// tolerance.
constexpr double kMargin = 0.8;
constexpr double kMaxSpacing = 8;  ///< greatest spacing, in voxels
constexpr double kMachineShare =
    0.5;  ///< share of memory for maps. assumed: points and programs need the rest
/// Greatest ratio of expectedMapBytes() to a map's memory; tests check it.
constexpr double kExpectedOverKept = 2.5;

/// Points on and near a part's surface, with their exact distances.
struct Check {
  Solid solid;
  std::vector<Vec3> points;
  std::vector<double> exact_m;
};

Check makeCheck(const Mesh& mesh, double reach_m) {
  Check check{Solid(mesh), {}, {}};
  const double spacing_m = std::sqrt(area(mesh) / static_cast<double>(kSamples));
  SeededDraw draw(7);
  for (const SurfaceSample& sample : sampleSurface(mesh, spacing_m, bounds(mesh))) {
    if (sample.area_m2 == 0 || draw() * static_cast<double>(kSamples) * sample.area_m2 > 2 * area(mesh))
      continue;
    const Vec3 aside = draw.inUnitCube() * (2 * reach_m);
    check.points.push_back(sample.p + aside);
    check.exact_m.push_back(check.solid.signedDistance(check.points.back()));
  }
  return check;
}

/// Error of the field [m] that a share of kShare of the points does not exceed.
double errorOf(const VoxMap& map, const Check& check) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < check.points.size(); ++i)
    errors.push_back(std::abs(map.distance(check.points[i]) - check.exact_m[i]));
  if (errors.empty()) return 0;
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(kShare * static_cast<double>(errors.size() - 1))];
}

/// Builds a scene's models at one fidelity after another.
class Chooser {
 public:
  Chooser(Scene& scene, const FidelityWish& wish, const ChoiceOptions& options)
      : scene_(scene), wish_(wish), options_(options) {
    choice_.fidelity = scene.fidelity;
  }

  FidelityChoice run() {
    if (wish_.tolerance_m ? !findVoxel() : !hasRoomForMaps(choice_.fidelity.voxel_m)) return choice_;
    count();
    while (!isAffordable() && coarsen()) count();
    finish();
    return choice_;
  }

 private:
  [[nodiscard]] bool isQuickEnough() const {
    return !wish_.budget_hz || choice_.step_us <= 1e6 / *wish_.budget_hz;
  }
  [[nodiscard]] bool isSmallEnough() const {
    return !wish_.memory_bytes || static_cast<double>(choice_.bytes) <= *wish_.memory_bytes;
  }
  [[nodiscard]] bool isAffordable() const { return isQuickEnough() && isSmallEnough(); }

  /// Estimates the memory of maps before the maps are built; sets failure_reason if the memory is too much.
  bool hasRoomForMaps(double voxel_m);
  bool findVoxel();
  [[nodiscard]] double worstError(double voxel_m, double enough_m);
  void count();
  bool coarsen();
  void finish();

  Scene& scene_;
  const FidelityWish& wish_;
  const ChoiceOptions& options_;
  std::vector<Check> checks_;
  FidelityChoice choice_;
};

/// The worst error of all parts; stops at the first part that exceeds `enough_m`.
double Chooser::worstError(double voxel_m, double enough_m) {
  double worst_m = 0;
  VoxMapSettings settings;
  settings.voxel_m = voxel_m;
  for (std::size_t i = 0; i < scene_.parts.size() && worst_m <= enough_m; ++i)
    worst_m = std::max(
        worst_m, errorOf(buildVoxMap(checks_[i].solid, settings, scene_.parts[i].part.name), checks_[i]));
  return worst_m;
}

bool Chooser::hasRoomForMaps(double voxel_m) {
  VoxMapSettings settings;
  settings.voxel_m = voxel_m;
  double bytes = 0;
  for (const ScenePart& part : scene_.parts) bytes += expectedMapBytes(part.part.mesh, settings);
  const double machine_bytes =
      options_.machine_bytes > 0 ? options_.machine_bytes : kMachineShare * machineMemoryBytes();
  // The estimate is up to kExpectedOverKept times the memory of the map, so a wish is refused only if no map
  // can meet it. If the wish has no tolerance, larger voxels may meet it.
  const bool fits_wish =
      !wish_.memory_bytes || !wish_.tolerance_m || bytes <= kExpectedOverKept * *wish_.memory_bytes;
  const bool fits_machine =
      machine_bytes == 0 || 2 * bytes <= machine_bytes;  // each map counts twice: in its part, and cooked
  if (fits_wish && fits_machine) return true;
  char words[300];
  std::snprintf(
      words, sizeof words,
      "the maps for the next voxel size, %.3g um, would need about %.3g MB%s, but only %.3g MB%s; allow a "
      "larger tolerance, or %s",
      1e6 * voxel_m, 1e-6 * bytes, fits_wish ? " twice (in the parts and in the cooked field)" : "",
      1e-6 * (fits_wish ? machine_bytes : *wish_.memory_bytes),
      fits_wish ? ", half of this machine's memory, may be used" : " are allowed",
      fits_wish ? "use a machine with more memory" : "more memory");
  choice_.failure_reason = words;
  return false;
}

bool Chooser::findVoxel() {
  for (const ScenePart& part : scene_.parts)
    checks_.push_back(makeCheck(part.part.mesh, std::min(*wish_.tolerance_m, 50e-6)));
  for (double voxel_m = kCoarsest_m; voxel_m >= kFinest_m; voxel_m *= kStep) {
    if (options_.progress) options_.progress("searching for a voxel size", 0.5);
    if (!hasRoomForMaps(voxel_m)) return false;
    choice_.error_m = worstError(voxel_m, kMargin * *wish_.tolerance_m);
    if (choice_.error_m > kMargin * *wish_.tolerance_m) continue;
    choice_.fidelity.voxel_m = voxel_m;
    scene_.fidelity.voxel_m = voxel_m;
    choice_.fidelity.spacing_m = usualSpacing_m(scene_);
    return true;
  }
  choice_.failure_reason =
      "no voxel size down to 15 um keeps the tolerance of depth; allow a larger tolerance";
  return false;
}

void Chooser::count() {
  scene_.fidelity = choice_.fidelity;
  for (ScenePart& part : scene_.parts) {
    if (!part.model) continue;
    PartModel kept = *part.model;
    if (kept.shell && kept.shell->spacing_m != choice_.fidelity.spacing_m) kept.shell.reset();
    if (kept.map && kept.map->voxel_m() != choice_.fidelity.voxel_m) kept.map.reset();
    part.model = std::make_shared<const PartModel>(std::move(kept));
  }
  buildModels(scene_, {});
  const ModelledCost cost = modelledCost(scene_);
  choice_.points = cost.points;
  choice_.bytes = 2 * cost.bytes;  // models are stored once in the parts and once in the cooked field
  std::size_t most = 0;
  for (const ScenePart& part : scene_.parts)
    if (!part.is_fixed) most = std::max(most, part.model->shell->size());
  // The part of a map that other parts can touch has no more surface than the moved part itself.
  choice_.points_near = choice_.fidelity.sides == Sides::Both ? 2 * most : most;
  choice_.step_us = kStepBase_us + kStepPoint_us * static_cast<double>(choice_.points_near);
}

bool Chooser::coarsen() {
  Fidelity& f = choice_.fidelity;
  if (f.spacing_m / kStep <= 1.001 * kMaxSpacing * f.voxel_m) {
    f.spacing_m /= kStep;
    return true;
  }
  // The points of one side miss the sharp edges of the other side, so that no tolerance is guaranteed.
  if (!isQuickEnough() && f.sides == Sides::Both && !wish_.tolerance_m) {
    f.sides = Sides::One;
    return true;
  }
  if (!isSmallEnough() && !wish_.tolerance_m && f.voxel_m / kStep <= kCoarsest_m) {
    f.voxel_m /= kStep;
    return true;
  }
  return false;
}

void Chooser::finish() {
  choice_.is_met = isAffordable();
  if (choice_.is_met) return;
  char words[200];
  if (!isQuickEnough())
    std::snprintf(words, sizeof words,
                  "a step takes %.0f us by the cost model with the fewest points, but at %.0f Hz it may take "
                  "only %.0f us; "
                  "allow a lower rate, or a larger tolerance",
                  choice_.step_us, *wish_.budget_hz, 1e6 / *wish_.budget_hz);
  else
    std::snprintf(
        words, sizeof words,
        "the models take %.3g MB with the fewest points, but only %.3g MB are allowed; allow more memory%s",
        1e-6 * static_cast<double>(choice_.bytes), 1e-6 * *wish_.memory_bytes,
        wish_.tolerance_m ? ", or a larger tolerance" : "");
  choice_.failure_reason = words;
}

std::string tomlValue(double value, const FieldTraits& traits) {
  char text[64];
  if (traits.quantity == Quantity::Length)
    std::snprintf(text, sizeof text, "\"%.6gum\"", 1e6 * value);
  else
    std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}
std::string tomlValue(int value, const FieldTraits& traits) {
  if (value == 0 && !traits.zero_word.empty()) return "\"" + std::string(traits.zero_word) + "\"";
  return std::to_string(value);
}
template <class Enum>
requires std::is_enum_v<Enum> std::string tomlValue(Enum value, const FieldTraits&) {
  return std::string("\"") + toText(value) + "\"";
}

}  // namespace

FidelityChoice chooseFidelity(Scene& scene, FidelityWish wish, const ChoiceOptions& options) {
  scene.fidelity_wish.reset();  // buildModels() refuses a scene that still has a wish
  return Chooser(scene, wish, options).run();
}

void resolveFidelity(Scene& scene, const ChoiceOptions& options) {
  if (!scene.fidelity_wish) return chooseResolution(scene);
  const FidelityWish wish = *scene.fidelity_wish;
  const FidelityChoice choice = chooseFidelity(scene, wish, options);
  if (!choice.is_met)
    throw LoadError(wish.place.empty() ? scene.file : wish.place, "",
                    "key 'fidelity' is auto and cannot be met: " + choice.failure_reason);
  scene.fidelity = choice.fidelity;
  scene.fidelity_choice = describe(choice);
}

std::string toToml(const Fidelity& fidelity) {
  std::string text = "[fidelity]\n";
  forEachRow(kFidelityFields, [&](const auto& row) {
    text += std::string(row.key) + " = " + tomlValue(std::invoke(row.get, fidelity), row.traits) + "\n";
  });
  return text;
}

std::string describe(const FidelityChoice& choice) {
  char text[300];
  const Fidelity& f = choice.fidelity;
  std::snprintf(
      text, sizeof text,
      "voxel %.3g mm, spacing %.3g mm, %s: %zu points, %.1f MB, a step of %.0f us by the cost model",
      1e3 * f.voxel_m, 1e3 * f.spacing_m, inWords(f.sides), choice.points,
      1e-6 * static_cast<double>(choice.bytes), choice.step_us);
  std::string words = text;
  if (choice.error_m > 0) {
    std::snprintf(text, sizeof text, ", depth error %.2g um", 1e6 * choice.error_m);
    words += text;
  }
  return words;
}

}  // namespace vps::scenes
