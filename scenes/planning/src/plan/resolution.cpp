// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/fidelity_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "models/meeting_sizes.h"
#include "models/scene_models.h"
#include "scene/steps.h"
#include "text/words.h"
#include "vps/voxmap.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/explain.h"

namespace vps::scenes {

namespace {

/// Memory limit of the models of one part: the memory of a cube of kLargestUsual_m.
double mostBytes() {
  static const double bytes =
      expectedMapBytes(makeBox(Vec3::Constant(kLargestUsual_m)), voxMapSettings(Fidelity()));
  return bytes;
}

/// A voxel size, and the size that it does not resolve.
struct Choice {
  double voxel_m = 0;
  std::string missed;  ///< the size below kVoxelsAcross voxels, in words; empty: all sizes are resolved
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

/// Composes "voxels of 1.5 mm for 'a', 'b', 'c' and 4 others": one clause per voxel size, with a warning if
/// the voxel size is too coarse.
class ChoiceWords {
 public:
  void add(const std::string& of, const Choice& choice) {
    const bool is_missed = !choice.missed.empty();
    if (choice.voxel_m == Fidelity().voxel_m && !is_missed) return;
    const std::string voxel = lengthInWords(choice.voxel_m);
    auto group = std::ranges::find_if(
        groups_, [&](const Group& g) { return g.voxel == voxel && g.missed.empty() != is_missed; });
    if (group == groups_.end()) group = groups_.insert(groups_.end(), {voxel, choice.missed, {}});
    group->names.push_back(of);
  }

  [[nodiscard]] std::string text() const {
    std::string words;
    for (const Group& group : groups_) {
      if (!words.empty()) words += "; ";
      words += "voxels of " + group.voxel + " for " + listOf(group.names);
      if (!group.missed.empty())
        words +=
            " (" + group.missed + " is less than eight voxels, so that contacts there may be missed" +
            (group.names.size() > 1 ? ", as may contacts at small features of the other parts" : "") +
            "; smaller voxels would exceed the memory limit of the automatic choice: set [fidelity] voxel)";
    }
    return words;
  }

 private:
  struct Group {
    std::string voxel, missed;  ///< voxel size, and the size that it misses in the group's first part
    std::vector<std::string> names;
  };

  static std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kNamed = 3;
    std::string list = names.front();
    for (std::size_t i = 1; i < std::min(kNamed, names.size()); ++i)
      list += (i + 1 == names.size() ? " and " : ", ") + names[i];
    if (names.size() > kNamed) list += " and " + std::to_string(names.size() - kNamed) + " others";
    return list;
  }

  std::vector<Group> groups_;
};

/// Chooses voxels for the parts of a scene without steps.
class FreeParts {
 public:
  explicit FreeParts(Scene& scene)
      : scene_(scene),
        sizes_(meetingSizes(scene, kVoxelsAcross * Fidelity().voxel_m)),
        own_(scene.parts.size()) {}

  void run() {
    chooseFixed();
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (!scene_.parts[i].is_fixed)
        own_[i] = capped(sizes_[i], fitting_m(scene_.parts[i], wanted_m(sizes_[i])));
    apply();
    const std::string sum = coarsenForSum();
    say(sum);
  }

 private:
  /// A choice, and whether the memory limit made its voxels coarser.
  struct Capped {
    Choice choice;
    bool is_capped = false;
  };

  [[nodiscard]] static double wanted_m(const MeetingSize& size) { return choose(size, 0).voxel_m; }
  [[nodiscard]] static Capped capped(const MeetingSize& size, double least_m) {
    if (!std::isfinite(least_m)) return {choose(size, 0), false};
    return {choose(size, least_m), least_m > wanted_m(size)};
  }

  void chooseFixed() {
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (scene_.parts[i].is_fixed && sizes_[i].least_m < least_fixed_.least_m) least_fixed_ = sizes_[i];
    double most_m = wanted_m(least_fixed_);
    for (const ScenePart& part : scene_.parts)
      if (part.is_fixed) most_m = std::max(most_m, fitting_m(part, wanted_m(least_fixed_)));
    fixed_ = capped(least_fixed_, most_m);
  }

  void apply() {
    scene_.fidelity.voxel_m = fixed_.choice.voxel_m;
    if (scene_.chooses_spacing) scene_.fidelity.spacing_m = usualSpacing_m(scene_);
    for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
      ScenePart& part = scene_.parts[i];
      part.voxel_m = part.spacing_m = 0;
      if (part.is_fixed || own_[i].choice.voxel_m == scene_.fidelity.voxel_m) continue;
      part.voxel_m = own_[i].choice.voxel_m;
      if (scene_.chooses_spacing) part.spacing_m = spacingWith_m(part.voxel_m);
    }
  }

  [[nodiscard]] double spacingWith_m(double voxel_m) {
    const double field_m = std::exchange(scene_.fidelity.voxel_m, voxel_m);
    const double spacing_m = usualSpacing_m(scene_);
    scene_.fidelity.voxel_m = field_m;
    return spacing_m;
  }

  [[nodiscard]] double modelBytes() const {
    return static_cast<double>(estimate(scene_, ModelPurpose::Simulate, {}).cost.most.bytes);
  }

  /// Enlarges all voxels that the memory limit chose by one common factor, until all models together take no
  /// more than kMostModels_bytes. Scenes with many large parts need this.
  /// @return the reason in words; empty: nothing was changed
  std::string coarsenForSum() {
    const bool is_any = fixed_.is_capped || std::ranges::any_of(own_, &Capped::is_capped);
    double bytes = is_any ? modelBytes() : 0;
    if (bytes <= kMostModels_bytes) return "";
    std::array<char, 160> words{};
    std::snprintf(
        words.data(), words.size(),
        "; larger voxels than each large part alone needs, since all models would take about %.0f MB",
        1e-6 * bytes);
    constexpr int kMostTries = 20;  // each try removes about the capped parts' share of the excess
    constexpr double kSurplus =
        1.02;  // the estimate is only about proportional to 1 / voxel^2, because of bricks
    for (int i = 0; i < kMostTries && bytes > kMostModels_bytes; ++i) {
      coarsen(std::sqrt(kSurplus * bytes / kMostModels_bytes));
      bytes = modelBytes();
    }
    return words.data();
  }

  void coarsen(double factor) {
    if (fixed_.is_capped) fixed_.choice = choose(least_fixed_, factor * fixed_.choice.voxel_m);
    for (std::size_t i = 0; i < own_.size(); ++i)
      if (own_[i].is_capped) own_[i].choice = choose(sizes_[i], factor * own_[i].choice.voxel_m);
    apply();
  }

  void say(const std::string& sum) {
    ChoiceWords words;
    words.add("the fixed parts", fixed_.choice);
    for (std::size_t i = 0; i < own_.size(); ++i)
      if (scene_.parts[i].voxel_m > 0 || !own_[i].choice.missed.empty())
        words.add("'" + scene_.parts[i].part.name + "'", own_[i].choice);
    scene_.resolution_choice = words.text() + sum;
  }

  Scene& scene_;
  std::vector<MeetingSize> sizes_;
  MeetingSize least_fixed_;
  Capped fixed_;
  std::vector<Capped> own_;  ///< choices by part; only for movable parts
};

}  // namespace

void chooseResolution(Scene& scene) {
  if (!scene.chooses_voxel || scene.fidelity_wish) return;
  for (ScenePart& part : scene.parts) part.voxel_m = part.spacing_m = 0;
  if (scene.steps.empty()) return FreeParts(scene).run();
  scene.resolution_choice = fitFidelity(scene);
}

}  // namespace vps::scenes
