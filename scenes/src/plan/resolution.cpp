// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/length_words.h"
#include "models/meeting_sizes.h"
#include "models/scene_models.h"
#include "scene/usual_spacing.h"
#include "vps/map_estimate.h"
#include "vps_scenes/plan.h"

namespace vps::scenes::inline v0 {

namespace {

/// What the models of one part may take: as much as those of a cube of kLargestUsual_m.
double mostBytes() {
  static const double bytes =
      expectedMapBytes(makeBox(Vec3::Constant(kLargestUsual_m)), voxMapSettings(Fidelity()));
  return bytes;
}

/// A voxel, and what it leaves unresolved.
struct Choice {
  double voxel_m = 0;
  std::string missed;  ///< what is less than kVoxelsAcross voxels, and why; empty: nothing is
};

Choice choose(const MeetingSize& size, double fitting_m) {
  const double usual_m = Fidelity().voxel_m;
  Choice choice{std::max(std::min(usual_m, size.least_m / kVoxelsAcross), fitting_m), ""};
  constexpr double kRounding = 1 + 1e-9;
  if (size.least_m * kRounding < kVoxelsAcross * choice.voxel_m) choice.missed = size.words;
  return choice;
}

double fitting_m(const ScenePart& part, double wanted_m) {
  VoxMapSettings settings;
  settings.voxel_m = wanted_m;
  return fittingVoxel_m(part.part.mesh, settings, mostBytes());
}

/// Chooses for the parts of a scene without steps.
class FreeParts {
 public:
  explicit FreeParts(Scene& scene)
      : scene_(scene), sizes_(meetingSizes(scene, kVoxelsAcross * Fidelity().voxel_m)) {}

  void run() {
    setFixed();
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (!scene_.parts[i].is_fixed) setMoving(i);
    scene_.resolution_choice = words_;
  }

 private:
  void setFixed() {
    MeetingSize least;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (scene_.parts[i].is_fixed && sizes_[i].least_m < least.least_m) least = sizes_[i];
    Choice choice = choose(least, 0);
    double most_m = choice.voxel_m;
    for (const ScenePart& part : scene_.parts)
      if (part.is_fixed) most_m = std::max(most_m, fitting_m(part, choice.voxel_m));
    if (std::isfinite(most_m)) choice = choose(least, most_m);
    scene_.fidelity.voxel_m = choice.voxel_m;
    if (scene_.chooses_spacing) scene_.fidelity.spacing_m = usualSpacing_m(scene_);
    say("the fixed parts", choice);
  }

  void setMoving(std::size_t i) {
    ScenePart& part = scene_.parts[i];
    Choice choice = choose(sizes_[i], 0);
    const double least_m = fitting_m(part, choice.voxel_m);
    if (std::isfinite(least_m)) choice = choose(sizes_[i], least_m);
    if (choice.voxel_m == scene_.fidelity.voxel_m) return;
    part.voxel_m = choice.voxel_m;
    if (scene_.chooses_spacing) part.spacing_m = spacingWith_m(choice.voxel_m);
    say("'" + part.part.name + "'", choice);
  }

  [[nodiscard]] double spacingWith_m(double voxel_m) {
    const double field_m = std::exchange(scene_.fidelity.voxel_m, voxel_m);
    const double spacing_m = usualSpacing_m(scene_);
    scene_.fidelity.voxel_m = field_m;
    return spacing_m;
  }

  void say(const std::string& of, const Choice& choice) {
    if (choice.voxel_m == Fidelity().voxel_m && choice.missed.empty()) return;
    if (!words_.empty()) words_ += "; ";
    words_ += "voxels of " + lengthInWords(choice.voxel_m) + " for " + of;
    if (!choice.missed.empty())
      words_ +=
          " (" + choice.missed +
          " is less than eight of them, so that its contacts may be missed; smaller ones would take more "
          "memory than is chosen by itself: [fidelity] voxel sets them)";
  }

  Scene& scene_;
  std::vector<MeetingSize> sizes_;
  std::string words_;
};

}  // namespace

void chooseResolution(Scene& scene) {
  if (!scene.chooses_voxel || scene.fidelity_wish) return;
  for (ScenePart& part : scene.parts) part.voxel_m = part.spacing_m = 0;
  if (scene.steps.empty()) return FreeParts(scene).run();
  if (scene.chooses_spacing) scene.resolution_choice = fitFidelity(scene);
}

}  // namespace vps::scenes::inline v0
