// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

#include "core/machine_memory.h"
#include "core/wall_clock.h"
#include "models/shrunk_mesh.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps/model_estimate.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"
#include "vps_scenes/scene/mesh_warning.h"

namespace vps::scenes {

VoxMapSettings voxMapSettings(const Fidelity& fidelity) {
  VoxMapSettings settings;
  settings.voxel_m = fidelity.voxel_m;
  return settings;
}

PointShellSettings pointShellSettings(const Fidelity& fidelity) {
  PointShellSettings settings;
  settings.spacing_m = fidelity.spacing_m;
  return settings;
}

Fidelity fidelityOf(const ScenePart& part, const Fidelity& fidelity) {
  Fidelity own = fidelity;
  if (part.voxel_m > 0) own.voxel_m = part.voxel_m;
  if (part.spacing_m > 0) own.spacing_m = part.spacing_m;
  return own;
}

namespace {

/// What map and shell are built from, and contacts and overlaps of a run are measured with. A rigid part
/// cannot give way, so that a part that is pressed in has none of its declared interference, half of it on
/// each side, and a little less than the 10 um that count as contact, since without clearance it would jam.
std::shared_ptr<const Solid> solidOf(const ScenePart& part, const Mesh& mesh) {
  constexpr double kPressSlack_m = 8e-6;
  const double by_m = part.press_fit_m > 0 ? 0.5 * part.press_fit_m + kPressSlack_m : 0;
  return std::make_shared<const Solid>(by_m > 0 ? shrunkMesh(mesh, by_m) : mesh, part.part.name);
}

/// What a cache knows a part's models by.
const Mesh& cachedMesh(const ScenePart& part, const Solid& solid) {
  return part.press_fit_m > 0 ? solid.mesh() : part.part.mesh;
}

/// Builds a part's shell, or takes it from the cache.
std::shared_ptr<const PointShell> shellOf(const ScenePart& part, const Solid& solid,
                                          const PointShellSettings& settings, const ModelOptions& options) {
  const std::string& name = part.part.name;
  return std::make_shared<PointShell>(
      options.cache != nullptr ? options.cache->buildShell(cachedMesh(part, solid), solid, settings, name)
                               : buildPointShell(solid, settings, name));
}

/// Builds a part's map, or takes it from the cache.
std::shared_ptr<const VoxMap> mapOf(const ScenePart& part, const Solid& solid, const VoxMapSettings& settings,
                                    const ModelOptions& options) {
  const std::string& name = part.part.name;
  MeshReport report;
  auto map =
      std::make_shared<VoxMap>(options.cache != nullptr ? options.cache->build(cachedMesh(part, solid), solid,
                                                                               settings, name, {}, &report)
                                                        : buildVoxMap(solid, settings, name, {}, &report));
  if (const std::string warning = meshWarning(report); options.warn && !warning.empty())
    options.warn(part.file + ": part '" + name + "' " + warning);
  return map;
}

/// What is still valid of the models that the part has, or of `shared`, which is the model of a part of equal
/// geometry. Name and material are always the part's own.
PartModel startingModel(const ScenePart& scene_part, const PartModel* shared) {
  const PartModel* from = shared != nullptr ? shared : scene_part.model.get();
  PartModel model = from != nullptr ? *from : PartModel{};
  if (shared == nullptr && scene_part.is_cropped) {
    model.map.reset();
    model.shell.reset();
  }
  model.name = scene_part.part.name;
  model.material = scene_part.part.material;
  if (!model.mesh) model.mesh = std::make_shared<const Mesh>(scene_part.part.mesh);
  return model;
}

void crop(PartModel& model, const std::vector<Box>& kept_P) {
  if (model.map) model.map = std::make_shared<VoxMap>(croppedVoxMap(*model.map, kept_P));
  if (model.shell) model.shell = std::make_shared<PointShell>(croppedShell(*model.shell, kept_P));
}

bool isCooked(const ModelPlan& plan, std::size_t part) {
  return std::ranges::any_of(
      plan.steps, [part](const FieldPlan& step) { return std::ranges::count(step.cooked, part) > 0; });
}

BuildTimes buildPart(ScenePart& scene_part, const PartModelPlan& planned, const Fidelity& fidelity,
                     const ModelOptions& options, PartModel& model) {
  BuildTimes times;
  double begun_s = wallSeconds();
  if (planned.has_map && !model.map)
    model.map = mapOf(scene_part, *model.solid, voxMapSettings(fidelity), options);
  times.map_wall_s = wallSeconds() - begun_s;
  begun_s = wallSeconds();
  if (planned.has_shell && !model.shell)
    model.shell = shellOf(scene_part, *model.solid, pointShellSettings(fidelity), options);
  scene_part.is_cropped = !planned.kept_P.empty();
  if (scene_part.is_cropped) crop(model, planned.kept_P);
  times.shell_wall_s = wallSeconds() - begun_s;
  return times;
}

bool isBuilt(const ModelPlan& plan, std::size_t part) {
  const PartModelPlan& planned = plan.parts[part];
  return !planned.same_as && (planned.has_map || planned.has_shell || isCooked(plan, part));
}

/// A part that is only in the fixed field has its map there.
bool needsMap(const ModelPlan& plan, std::size_t part) {
  return isBuilt(plan, part) && (plan.parts[part].has_map || isCooked(plan, part));
}

/// To two digits, never down.
double roundedUp(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return digit * std::ceil(value / digit * (1 - 1e-12));
}

bool needsShell(const ModelPlan& plan, std::size_t part) {
  return isBuilt(plan, part) && plan.parts[part].has_shell;
}

using FidelityOf = std::function<Fidelity(const ScenePart&)>;

/// About what whole models of a plan take, by areas alone: seldom less than they do take.
double mostModelBytes(const Scene& scene, const ModelPlan& plan, const FidelityOf& of) {
  constexpr double kDensest = 2;  // points for each square of the spacing; more where edges are near
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

/// The models' memory where it may be less than some limit, else about that. The first takes points on all
/// edges, which are many where the spacing is far too small; the second O(triangles).
double aboutModelBytes(const Scene& scene, const ModelPlan& plan, const FidelityOf& of, double most_bytes) {
  constexpr double kFar = 8;  // by areas alone at most twice as much; then cropped models keep a share
  const double by_areas = mostModelBytes(scene, plan, of);
  const bool is_known = by_areas <= most_bytes || by_areas > kFar * most_bytes;
  const bool is_cropped =
      std::ranges::any_of(plan.parts, [](const PartModelPlan& part) { return !part.kept_P.empty(); });
  return is_known && !(is_cropped && by_areas > most_bytes) ? by_areas : modelBytes(scene, plan, of);
}

/// To two digits, never down, in millimetres.
double roundedLength_m(double length_m) {
  constexpr double kRounding = 1 + 1e-12;
  return 1e-3 * roundedUp(1e3 * length_m * kRounding);
}

Fidelity scaled(Fidelity fidelity, double factor) {
  fidelity.voxel_m = roundedLength_m(factor * fidelity.voxel_m);
  fidelity.spacing_m = roundedLength_m(factor * fidelity.spacing_m);
  return fidelity;
}

/// Finds a voxel and a spacing with which the models of a plan are built, all with the same, as where a scene
/// states them. What is found passes the checks below.
class Remedy {
 public:
  Remedy(const Scene& scene, const ModelPlan& plan, double most_bytes)
      : scene_(scene), plan_(plan), most_bytes_(most_bytes > 0 ? most_bytes : kNoLimit) {}

  /// The least, to two digits.
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

  /// The scene's, made larger where a map or a shell would not be built: of these the other one need not be.
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

/// Refuses a map or a shell that would not be built, before the others are: some take minutes. O(triangles).
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
                      "voxmap takes at most %.0f; set larger ones in the scene file: ",
                      size_mm.x(), size_mm.y(), size_mm.z(), bytes / kGiB, 1e3 * voxels.voxel_m,
                      largestMapBytes() / kGiB);
    }
    if (words[0] == 0 && needsShell(plan, i) && !(part.model && part.model->shell) &&
        fittingSpacing_m(mesh, fidelity.spacing_m) > fidelity.spacing_m)
      std::snprintf(
          words.data(), words.size(),
          "of %.4g x %.4g x %.4g mm has too many points for a pointshell with a spacing of %.3g mm; "
          "set a larger one in the scene file: ",
          size_mm.x(), size_mm.y(), size_mm.z(), 1e3 * fidelity.spacing_m);
    if (words[0] != 0)
      throw LoadError(part.file, part.part.name, words.data() + Remedy(scene, plan, most_bytes).words());
  }
}

/// Refuses a plan whose models need more memory than there is, since the system would end the program without
/// a word. The exact estimate is only made where the areas alone do not tell. O(triangles).
void requireMemory(const Scene& scene, const ModelPlan& plan, double most_bytes) {
  if (!(most_bytes > 0)) return;
  const double about = aboutModelBytes(
      scene, plan, [&](const ScenePart& part) { return fidelityOf(part, scene.fidelity); }, most_bytes);
  if (about <= most_bytes) return;
  std::array<char, 200> words{};
  std::snprintf(words.data(), words.size(),
                "its models need about %.3g MB of memory, and there are %.3g MB; choose larger voxels and "
                "spacing (",
                1e-6 * about, 1e-6 * most_bytes);
  throw LoadError(scene.file, "",
                  words.data() + Remedy(scene, plan, most_bytes).words() +
                      "), or leave parts out that nothing touches (vps explain lists what each part needs)");
}

/// Builds the models of a scene's parts on all cores. Each part's models depend on that part alone, and
/// warnings and errors are passed on in the order of the parts, so that the result does not depend on timing.
class ModelBuilder {
 public:
  ModelBuilder(Scene& scene, const ModelPlan& plan, std::vector<std::size_t> parts,
               const ModelOptions& options)
      : scene_(scene),
        plan_(plan),
        parts_(std::move(parts)),
        options_(options),
        times_(scene.parts.size()),
        warnings_(scene.parts.size()),
        errors_(scene.parts.size()),
        first_failed_(scene.parts.size()) {}

  std::vector<BuildTimes> run() {
    const std::vector<std::size_t> order = largestFirst();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) tryPart(order[k]);
        },
        tbb::simple_partitioner());
    for (const std::size_t i : parts_) {
      if (errors_[i]) std::rethrow_exception(errors_[i]);
      if (options_.warn) std::ranges::for_each(warnings_[i], options_.warn);
      if (plan_.parts[i].same_as) share(i);
    }
    if (options_.progress) options_.progress("modelling", 1);
    return std::move(times_);
  }

 private:
  /// The parts with models of their own, so that no core is left with a large one at the end.
  [[nodiscard]] std::vector<std::size_t> largestFirst() {
    std::vector<std::size_t> order;
    for (const std::size_t i : parts_)
      if (!plan_.parts[i].same_as) order.push_back(i);
    const auto size = [&](std::size_t i) { return scene_.parts[i].part.mesh.triangles.size(); };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    for (const std::size_t i : order) triangles_ += size(i);
    return order;
  }

  void tryPart(std::size_t i) {
    if (i > first_failed_) return;
    try {
      report(i);
      // Without isolation a thread that waits for one part's voxels would begin another part.
      tbb::this_task_arena::isolate([&] { build(i); });
    } catch (...) {
      errors_[i] = std::current_exception();
      for (std::size_t first = first_failed_; i < first && !first_failed_.compare_exchange_weak(first, i);) {
      }
    }
  }

  /// Progress is counted in triangles of the parts that were begun.
  void report(std::size_t i) {
    if (!options_.progress) return;
    const std::lock_guard lock(reporting_);
    options_.progress(
        "modelling " + scene_.parts[i].part.name,
        static_cast<double>(begun_) / static_cast<double>(std::max<std::size_t>(1, triangles_)));
    begun_ += scene_.parts[i].part.mesh.triangles.size();
  }

  /// True if the part needs a solid at least.
  [[nodiscard]] bool isModelled(std::size_t i) const {
    return plan_.parts[i].has_map || plan_.parts[i].has_shell || isCooked(plan_, i);
  }

  void build(std::size_t i) {
    ScenePart& part = scene_.parts[i];
    requireUsable(part.part.mesh, part.file, part.part.name);
    if (!isModelled(i) && !part.model) return;
    ModelOptions options = options_;
    options.warn = [&](const std::string& text) { warnings_[i].push_back(text); };
    PartModel model = startingModel(part, nullptr);
    if (isModelled(i) && !model.solid) model.solid = solidOf(part, *model.mesh);
    times_[i] = buildPart(part, plan_.parts[i], fidelityOf(part, scene_.fidelity), options, model);
    part.model = std::make_shared<const PartModel>(std::move(model));
  }

  /// Takes the models of an earlier part of equal geometry.
  void share(std::size_t i) {
    ScenePart& part = scene_.parts[i];
    part.is_cropped = false;
    part.model = std::make_shared<const PartModel>(
        startingModel(part, scene_.parts[*plan_.parts[i].same_as].model.get()));
  }

  Scene& scene_;
  const ModelPlan& plan_;
  const std::vector<std::size_t> parts_;  ///< ascending
  const ModelOptions& options_;
  std::vector<BuildTimes> times_;
  std::vector<std::vector<std::string>> warnings_;  ///< by part
  std::vector<std::exception_ptr> errors_;          ///< by part
  std::atomic<std::size_t> first_failed_;           ///< later parts need not be begun
  std::mutex reporting_;
  std::size_t triangles_ = 0, begun_ = 0;
};

}  // namespace

void requireModelsFit(const Scene& scene, const ModelPlan& plan, const ModelOptions& options) {
  const double most_bytes = options.memory_bytes > 0 ? options.memory_bytes : machineMemoryBytes();
  requireParts(scene, plan, most_bytes);
  requireMemory(scene, plan, most_bytes);
}

std::vector<BuildTimes> buildModels(Scene& scene, const ModelPlan& plan, const ModelOptions& options) {
  std::vector<std::size_t> parts(scene.parts.size());
  std::iota(parts.begin(), parts.end(), 0U);
  return buildModels(scene, plan, std::move(parts), options);
}

std::vector<BuildTimes> buildModels(Scene& scene, const ModelPlan& plan, std::vector<std::size_t> parts,
                                    const ModelOptions& options) {
  requireModelsFit(scene, plan, options);
  if (scene.fidelity_wish)
    throw LoadError(scene.file, "",
                    "asks for an automatic fidelity that was not chosen yet; call resolveFidelity() first");
  return ModelBuilder(scene, plan, std::move(parts), options).run();
}

void buildModels(Scene& scene, const ModelOptions& options) {
  buildModels(scene, makeSharedModelPlan(scene), options);
}

void buildWhole(Scene& scene, ModelPlan& plan, const ModelOptions& options) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    PartModelPlan& planned = plan.parts[i];
    planned.kept_P.clear();
    if (scene.parts[i].is_fixed) planned.has_map = planned.has_shell = true;
  }
  for (FieldPlan& step : plan.steps) {
    step.region_W.reset();
    step.has_shell = true;
  }
  buildModels(scene, plan, options);
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
