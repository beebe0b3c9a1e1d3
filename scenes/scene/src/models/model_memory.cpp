// SPDX-License-Identifier: BSD-3-Clause
// Estimates the memory of a scene's models and refuses models that do not fit before any is built; the
// message states a voxel that fits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>

#include "core/machine.h"
#include "models/scene_models.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps/model_estimate.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps::scenes {

bool isCooked(const ModelPlan& plan, std::size_t part) {
  return std::ranges::any_of(
      plan.steps, [part](const FieldPlan& step) { return std::ranges::count(step.cooked, part) > 0; });
}

namespace {

bool isBuilt(const ModelPlan& plan, std::size_t part) {
  const PartModelPlan& planned = plan.parts[part];
  return !planned.same_as && (planned.has_map || planned.has_shell || isCooked(plan, part));
}

/// Whether a map of the part is built, be it the part's own or its share of the fixed field.
bool needsMap(const ModelPlan& plan, std::size_t part) {
  return isBuilt(plan, part) && (plan.parts[part].has_map || isCooked(plan, part));
}

/// Rounds up to two digits.
double roundedUp(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return digit * std::ceil(value / digit * (1 - 1e-12));
}

bool needsShell(const ModelPlan& plan, std::size_t part) {
  return isBuilt(plan, part) && plan.parts[part].has_shell;
}

using FidelityOf = std::function<Fidelity(const ScenePart&)>;

/// Estimated memory of a plan's complete models, from areas alone; seldom less than the actual memory.
double mostModelBytes(const Scene& scene, const ModelPlan& plan, const FidelityOf& of) {
  constexpr double kDensest = 2;  // points in a square with the spacing as side; more near edges
  double bytes = 0;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (!isBuilt(plan, i)) continue;
    const Mesh& mesh = scene.parts[i].part.mesh;
    const Fidelity fidelity = of(scene.parts[i]);
    if (needsMap(plan, i)) bytes += expectedMapBytes(mesh, voxMapSettings(fidelity));
    bytes += ModelEstimate::shellBytes(kDensest * area(mesh) / (fidelity.spacing_m * fidelity.spacing_m));
  }
  return bytes;
}

double modelBytes(const Scene& scene, const ModelPlan& plan, const FidelityOf& of) {
  double bytes = 0;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (!isBuilt(plan, i)) continue;
    const Fidelity fidelity = of(scene.parts[i]);
    const PartModelPlan& planned = plan.parts[i];
    const ModelEstimate estimate(
        scene.parts[i].part.mesh, voxMapSettings(fidelity), pointShellSettings(fidelity),
        planned.kept_P.empty() ? ModelEstimate::Extent::WholeOnly : ModelEstimate::Extent::Any);
    if (needsMap(plan, i)) bytes += estimate.mapBytes(planned.kept_P);
    if (planned.has_shell) bytes += ModelEstimate::shellBytes(estimate.pointCount(planned.kept_P));
  }
  return bytes;
}

/// Estimated memory of the models: computed from points where the estimate from areas does not decide whether
/// the models fit, else from areas. The estimate from points needs the points on all edges, which are many if
/// the spacing is far too small; the estimate from areas is O(triangles).
double aboutModelBytes(const Scene& scene, const ModelPlan& plan, const FidelityOf& of, double most_bytes) {
  constexpr double kFar = 8;  // the estimate from areas is at most twice the memory of complete models;
                              // cropped models need a share of the memory of complete models
  const double by_areas = mostModelBytes(scene, plan, of);
  const bool is_known = by_areas <= most_bytes || by_areas > kFar * most_bytes;
  const bool is_cropped =
      std::ranges::any_of(plan.parts, [](const PartModelPlan& part) { return !part.kept_P.empty(); });
  return is_known && !(is_cropped && by_areas > most_bytes) ? by_areas : modelBytes(scene, plan, of);
}

/// Rounds up to two digits in millimetres.
double roundedLength_m(double length_m) {
  constexpr double kRounding = 1 + 1e-12;
  return 1e-3 * roundedUp(1e3 * length_m * kRounding);
}

Fidelity scaled(Fidelity fidelity, double factor) {
  fidelity.voxel_m = roundedLength_m(factor * fidelity.voxel_m);
  fidelity.spacing_m = roundedLength_m(factor * fidelity.spacing_m);
  return fidelity;
}

/// Finds one voxel and one spacing for all parts, as a scene file can state them, with which the models of a
/// plan pass requireParts() and requireMemory().
class Remedy {
 public:
  Remedy(const Scene& scene, const ModelPlan& plan, double most_bytes)
      : scene_(scene), plan_(plan), most_bytes_(most_bytes > 0 ? most_bytes : kNoLimit) {}

  /// The least voxel and spacing with which the models fit, to two digits.
  [[nodiscard]] Fidelity find() const {
    const Fidelity least = leastOfParts();
    double high = 1;
    for (int i = 0; i < 40 && !fits(scaled(least, high)); ++i) high *= 2;
    double low = high;
    for (int i = 0; i < 10 && fits(scaled(least, low)); ++i) low /= 2;
    while (high > 1.02 * low) {
      const double middle = std::sqrt(low * high);
      (fits(scaled(least, middle)) ? high : low) = middle;
    }
    return scaled(least, high);
  }
  [[nodiscard]] std::string words() const {
    const Fidelity found = find();
    std::array<char, 120> words{};
    std::snprintf(words.data(), words.size(), "[fidelity] voxel = \"%.6gmm\", spacing = \"%.6gmm\"",
                  1e3 * found.voxel_m, 1e3 * found.spacing_m);
    return words.data();
  }

 private:
  static constexpr double kNoLimit = 1e300;

  /// The scene's fidelity with a larger voxel if a map would be too large, and a larger spacing if a shell
  /// would have too many points.
  [[nodiscard]] Fidelity leastOfParts() const {
    constexpr double kCertain = 1.001;  // see fittingVoxel_m()
    Fidelity least = scene_.fidelity;
    forEachBuilt([&](std::size_t i, const Mesh& mesh) {
      const double voxel_m = fittingVoxel_m(mesh, voxMapSettings(scene_.fidelity), largestMapBytes());
      if (needsMap(plan_, i) && voxel_m > scene_.fidelity.voxel_m && std::isfinite(voxel_m))
        least.voxel_m = std::max(least.voxel_m, kCertain * voxel_m);
    });
    if (scene_.chooses_spacing) least.spacing_m *= least.voxel_m / scene_.fidelity.voxel_m;
    const double spacing_m = least.spacing_m;
    forEachBuilt([&](std::size_t i, const Mesh& mesh) {
      if (needsShell(plan_, i))
        least.spacing_m = std::max(least.spacing_m, fittingSpacing_m(mesh, spacing_m));
    });
    return least;
  }

  [[nodiscard]] bool fits(const Fidelity& all) const {
    bool are_built = true;
    forEachBuilt([&](std::size_t i, const Mesh& mesh) {
      if (needsMap(plan_, i)) are_built &= expectedMapBytes(mesh, voxMapSettings(all)) <= largestMapBytes();
      if (needsShell(plan_, i)) are_built &= fittingSpacing_m(mesh, all.spacing_m) <= all.spacing_m;
    });
    const auto same = [&](const ScenePart&) { return all; };
    return are_built && aboutModelBytes(scene_, plan_, same, most_bytes_) <= most_bytes_;
  }

  template <typename Visit>
  void forEachBuilt(Visit visit) const {
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (isBuilt(plan_, i)) visit(i, scene_.parts[i].part.mesh);
  }

  const Scene& scene_;
  const ModelPlan& plan_;
  const double most_bytes_;
};

/// Refuses a map or a shell that could not be built, before the build of other models, which may take
/// minutes. O(triangles).
void requireParts(const Scene& scene, const ModelPlan& plan, double most_bytes) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    const Mesh& mesh = part.part.mesh;
    const Fidelity fidelity = fidelityOf(part, scene.fidelity);
    const Vec3 size_mm = 1e3 * bounds(mesh).size();
    std::array<char, 300> words{};
    if (needsMap(plan, i) && !(part.model && part.model->map)) {
      const VoxMapSettings voxels = voxMapSettings(fidelity);
      constexpr double kGiB = 1024.0 * 1024 * 1024;
      if (const double bytes = expectedMapBytes(mesh, voxels); bytes > largestMapBytes())
        std::snprintf(words.data(), words.size(),
                      "of %.4g x %.4g x %.4g mm needs about %.3g GiB of memory for voxels of %.3g mm, and a "
                      "voxmap may take at most %.0f GiB; set larger voxels in the scene file: ",
                      size_mm.x(), size_mm.y(), size_mm.z(), bytes / kGiB, 1e3 * voxels.voxel_m,
                      largestMapBytes() / kGiB);
    }
    if (words[0] == 0 && needsShell(plan, i) && !(part.model && part.model->shell) &&
        fittingSpacing_m(mesh, fidelity.spacing_m) > fidelity.spacing_m)
      std::snprintf(
          words.data(), words.size(),
          "of %.4g x %.4g x %.4g mm has too many points for a pointshell with a spacing of %.3g mm; "
          "set a larger spacing in the scene file: ",
          size_mm.x(), size_mm.y(), size_mm.z(), 1e3 * fidelity.spacing_m);
    if (words[0] != 0)
      throw LoadError(part.file, part.part.name, words.data() + Remedy(scene, plan, most_bytes).words());
  }
}

/// Refuses a plan whose models need more memory than the machine has, since the system would end the program
/// without a message. O(triangles).
void requireMemory(const Scene& scene, const ModelPlan& plan, double most_bytes) {
  if (!(most_bytes > 0)) return;
  const double about = aboutModelBytes(
      scene, plan, [&](const ScenePart& part) { return fidelityOf(part, scene.fidelity); }, most_bytes);
  if (about <= most_bytes) return;
  std::array<char, 200> words{};
  std::snprintf(
      words.data(), words.size(),
      "the models of its parts need about %.3g MB of memory, but only %.3g MB are available; choose larger "
      "voxels and spacing (",
      1e-6 * about, 1e-6 * most_bytes);
  throw LoadError(
      scene.file, "",
      words.data() + Remedy(scene, plan, most_bytes).words() +
          "), or leave out parts that nothing touches (vps explain lists the memory of each part)");
}

}  // namespace

void requireModelsFit(const Scene& scene, const ModelPlan& plan, const ModelOptions& options) {
  const double most_bytes = options.memory_bytes > 0 ? options.memory_bytes : machineMemoryBytes();
  requireParts(scene, plan, most_bytes);
  requireMemory(scene, plan, most_bytes);
}

ModelledCost modelledCost(const Scene& scene) {
  ModelledCost cost;
  std::set<const void*> seen;
  for (const ScenePart& part : scene.parts) {
    if (!part.model) continue;
    const PartModel& model = *part.model;
    if (model.map && seen.insert(model.map.get()).second) {
      ++cost.voxmaps;
      cost.bytes += model.map->memoryBytes();
    }
    if (model.shell && seen.insert(model.shell.get()).second) {
      ++cost.pointshells;
      cost.points += model.shell->size();
      cost.bytes += model.shell->memoryBytes();
    }
  }
  return cost;
}

}  // namespace vps::scenes
