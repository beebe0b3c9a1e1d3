// SPDX-License-Identifier: BSD-3-Clause
// Chooses voxels for a scene with steps, from the sizes of its parts and fits and the memory of the models.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "models/meeting_sizes.h"
#include "scene/steps.h"
#include "text/words.h"
#include "vps/box.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/explain.h"

namespace vps::scenes {

namespace {

constexpr double kStep = 1.4142135623730951;  // ratio of successive voxel sizes; each step halves the memory
constexpr double kFineShare = 0.2;            // share of the memory limit for voxels finer than the preset's

double modelBytes(const Scene& scene) {
  return static_cast<double>(estimate(scene, ModelPurpose::Assemble, {}).cost.most.bytes);
}

/// True if the scene file leaves the voxel open but states the spacing, which is then kept.
bool keepsSpacing(const Scene& scene) {
  return scene.chooses_voxel && !scene.chooses_spacing;
}

void setVoxel(Scene& scene, double voxel_m) {
  scene.fidelity.voxel_m = voxel_m;
  if (!keepsSpacing(scene)) scene.fidelity.spacing_m = usualSpacing_m(scene);
}

/// Enlarges the voxels in steps, up to a limit, until the models fit into the memory; the memory is inversely
/// proportional to the square of the voxel.
/// @return memory of the models [bytes]
double coarsen(Scene& scene, double most_bytes, double coarsest_m) {
  double bytes = modelBytes(scene);
  while (bytes > most_bytes && scene.fidelity.voxel_m < coarsest_m) {
    const double steps = std::max(1.0, std::floor(std::log2(bytes / most_bytes)));
    setVoxel(scene, std::min(coarsest_m, scene.fidelity.voxel_m * std::pow(kStep, steps)));
    bytes = modelBytes(scene);
  }
  return bytes;
}

/// Upper limit of the voxel: the largest part is kVoxelsAcross voxels across.
double coarsest_m(const Scene& scene) {
  double size_m = 0;
  for (const ScenePart& part : scene.parts)
    size_m = std::max(size_m, bounds(part.part.mesh).size().maxCoeff());
  return std::max(scene.fidelity.voxel_m, size_m / kVoxelsAcross);
}

/// The least size that has to be resolved.
struct LeastSize {
  double size_m = std::numeric_limits<double>::infinity();
  std::string name;  ///< name of the part
  std::string
      words;  ///< name of a fit: "the gap in 'gear' of 100 um"; empty: the least size is that of a part
};

LeastSize leastSize(const Scene& scene) {
  LeastSize least;
  for (const SceneStep& step : scene.steps) {
    const Part& part = scene.parts[step.part].part;
    if (const double size_m = across_m(part.mesh); size_m < least.size_m) least = {size_m, part.name, ""};
  }
  const double most_m = std::min(least.size_m, kVoxelsAcross * Fidelity().voxel_m);
  for (const MeetingSize& fit : meetingSizes(scene, most_m))
    if (fit.least_m < least.size_m) least = {fit.least_m, "", fit.words};
  return least;
}

std::string megabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f MB", 1e-6 * bytes);
  return text;
}

}  // namespace

std::string fitFidelity(Scene& scene, double most_bytes) {
  const Fidelity usual;
  const double spacing_m = scene.fidelity.spacing_m;
  const bool is_usual =
      !scene.fidelity_wish && scene.fidelity.voxel_m == usual.voxel_m &&
      (keepsSpacing(scene) || spacing_m == usual.spacing_m || spacing_m == usualSpacing_m(scene));
  if (!is_usual || scene.steps.empty()) return "";
  setVoxel(scene, usual.voxel_m);
  const LeastSize least = leastSize(scene);
  const double wanted_m = std::min(usual.voxel_m, least.size_m / kVoxelsAcross);
  double bytes = 0;
  if (wanted_m < usual.voxel_m) {
    setVoxel(scene, wanted_m);
    bytes = coarsen(scene, kFineShare * most_bytes, usual.voxel_m);
  }
  if (scene.fidelity.voxel_m == usual.voxel_m) bytes = modelBytes(scene);
  const double usual_bytes = bytes;
  if (bytes > most_bytes) coarsen(scene, most_bytes, coarsest_m(scene));

  const double voxel_m = scene.fidelity.voxel_m;
  const bool is_missed = least.size_m < kVoxelsAcross * voxel_m * (1 - 1e-9);
  if (voxel_m == usual.voxel_m && !is_missed) return "";
  std::string words = "voxels of " + lengthInWords(voxel_m);
  if (voxel_m > usual.voxel_m)
    words +=
        ": with " + lengthInWords(usual.voxel_m) + " the models would take about " + megabytes(usual_bytes);
  const std::string size = lengthInWords(least.size_m);
  if (is_missed)
    words += "; " + (least.words.empty() ? "'" + least.name + "', " + size + " across," : least.words) +
             " is less than eight voxels, so that its contacts may be missed; smaller voxels would take too "
             "much memory: plan this part in a scene of its own, or set [fidelity]";
  else if (voxel_m < usual.voxel_m)
    words += ", since " + (least.words.empty() ? "'" + least.name + "' is " + size + " across"
                                               : least.words + " has to be resolved");
  return words;
}

}  // namespace vps::scenes
