// SPDX-License-Identifier: BSD-3-Clause
// Voxels of a planned scene, by the size of its parts and the memory that they take.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/length_words.h"
#include "scene/usual_spacing.h"
#include "vps_scenes/explain.h"
#include "vps_scenes/plan.h"

namespace vps::scenes::inline v0 {

namespace {

/// Voxels across the least size of a part. Measured with a peg of 8 mm (scenes/peg_in_hole): with 1 mm it is
/// brought home less than 1 um deep, with 2 mm it gets 129 um deep into the rim of its hole.
constexpr double kLeastAcross = 8;
constexpr double kFinest_m = 30e-6;           // assumed: parts of 0.25 mm
constexpr double kStep = 1.4142135623730951;  // ratio of voxel sizes: half of the memory
constexpr double kFineShare = 0.2;            // of the memory, for voxels finer than the preset's
constexpr double kCoarsest_m = 16e-3;         // assumed: parts of 130 mm and more

double modelBytes(const Scene& scene) {
  return static_cast<double>(estimate(scene, ModelPurpose::Assemble, {}).cost.most.bytes);
}

void setVoxel(Scene& scene, double voxel_m) {
  scene.fidelity.voxel_m = voxel_m;
  scene.fidelity.spacing_m = usualSpacing_m(scene);
}

/// Coarser voxels, in steps up to the limit, until the models fit; the memory goes with the square of the
/// voxel.
/// @return the memory
double coarsen(Scene& scene, double most_bytes, double coarsest_m) {
  double bytes = modelBytes(scene);
  while (bytes > most_bytes && scene.fidelity.voxel_m < coarsest_m) {
    const double steps = std::max(1.0, std::floor(std::log2(bytes / most_bytes)));
    setVoxel(scene, std::min(coarsest_m, scene.fidelity.voxel_m * std::pow(kStep, steps)));
    bytes = modelBytes(scene);
  }
  return bytes;
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
  const bool is_usual = !scene.fidelity_wish && scene.fidelity.voxel_m == usual.voxel_m &&
                        (spacing_m == usual.spacing_m || spacing_m == usualSpacing_m(scene));
  if (!is_usual || scene.steps.empty()) return "";
  setVoxel(scene, usual.voxel_m);
  const SmallestPart smallest = smallestMoved(scene);
  const double wanted_m = std::min(usual.voxel_m, std::max(kFinest_m, smallest.across_m / kLeastAcross));
  double bytes = 0;
  if (wanted_m < usual.voxel_m) {
    setVoxel(scene, wanted_m);
    bytes = coarsen(scene, kFineShare * most_bytes, usual.voxel_m);
  }
  if (scene.fidelity.voxel_m == usual.voxel_m) bytes = modelBytes(scene);
  const double usual_bytes = bytes;
  if (bytes > most_bytes) coarsen(scene, most_bytes, kCoarsest_m);

  const double voxel_m = scene.fidelity.voxel_m;
  const bool is_missed = smallest.across_m < kLeastAcross * voxel_m * (1 - 1e-9);
  if (voxel_m == usual.voxel_m && !is_missed) return "";
  std::string words = "voxels of " + lengthInWords(voxel_m);
  if (voxel_m > usual.voxel_m)
    words +=
        ": with " + lengthInWords(usual.voxel_m) + " the models would take some " + megabytes(usual_bytes);
  if (is_missed)
    words +=
        "; '" + smallest.name + "', " + lengthInWords(smallest.across_m) +
        " across, is less than eight of them, so that its contacts may be missed, and smaller ones would "
        "take much memory: plan it in a scene of its own, or set [fidelity]";
  else if (voxel_m < usual.voxel_m)
    words += ", since '" + smallest.name + "' is " + lengthInWords(smallest.across_m) + " across";
  return words;
}

}  // namespace vps::scenes::inline v0
