// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/machine.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps/mesh_repair.h"
#include "vps/pointshell.h"
#include "vps/stoppable.h"
#include "vps/voxmap.h"

namespace vps::scenes {

std::string meshWarning(const MeshReport& report) {
  if (!report.signed_by_winding && !report.is_union_incomplete) return {};
  const bool has_faults = !report.isClosed() || report.overlapping_shells > 0 || report.internal_facets > 0 ||
                          report.sheet_facets > 0 || report.duplicate_triangles > 0 ||
                          report.united_shells > 0 || report.is_union_incomplete;
  if (!has_faults && report.certain_share >= 1) return {};
  const bool is_as_given = report.is_union_incomplete && !report.signed_by_winding;
  std::string words = !report.isClosed() ? "is not a closed surface: "
                      : is_as_given      ? "has shells that meet: "
                                         : "is repaired: ";
  const std::string found = describe(report);
  words += found.substr(0, found.rfind(';'));
  char certain[96];
  // The share is rounded down, so that 100 % means all of the space.
  std::snprintf(certain, sizeof certain,
                "; inside and outside are certain for %.4g %% of the space near the surface",
                std::floor(1e4 * report.certain_share) / 1e2);
  return words + certain;
}

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

/// The solid from which map and shell are built, and with which a run measures contacts and overlaps. A rigid
/// part cannot deform, so a part that is pressed in is reduced by its declared interference, half of it on
/// each side, and by a little less than the 10 um that count as contact, since the part would jam without
/// clearance.
std::shared_ptr<const Solid> solidOf(const ScenePart& part, const Mesh& mesh) {
  constexpr double kPressSlack_m = 8e-6;
  const double by_m = part.press_fit_m > 0 ? 0.5 * part.press_fit_m + kPressSlack_m : 0;
  return std::make_shared<const Solid>(by_m > 0 ? shrunkMesh(mesh, by_m) : mesh, part.part.name);
}

/// The mesh that identifies a part's models in a cache.
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

/// A model that begins with the valid models of the part itself, or with `shared`, the model of a part of
/// equal geometry. Name and material are always the part's own.
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
        work_(options.progress, "modelling"),
        times_(scene.parts.size()),
        warnings_(scene.parts.size()),
        errors_(scene.parts.size()),
        first_failed_(scene.parts.size()) {}

  std::vector<BuildTimes> run() {
    const std::vector<std::size_t> order = largestFirst();
    StoppableWork* const own = WorkOnThread::current();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const WorkOnThread on_thread(own);
          for (std::size_t k = range.begin(); k < range.end(); ++k) tryPart(order[k]);
        },
        tbb::simple_partitioner());
    for (const std::size_t i : parts_) {
      if (errors_[i]) std::rethrow_exception(errors_[i]);
      if (options_.warn) std::ranges::for_each(warnings_[i], options_.warn);
      if (plan_.parts[i].same_as) share(i);
    }
    work_.report("modelling", 1);
    return std::move(times_);
  }

 private:
  /// The parts with models of their own, largest first, so that no core begins a large part at the end.
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
      // Without isolation, a thread that waits for the voxels of a part would begin another part.
      tbb::this_task_arena::isolate([&] { build(i); });
    } catch (...) {
      errors_[i] = std::current_exception();
      for (std::size_t first = first_failed_; i < first && !first_failed_.compare_exchange_weak(first, i);) {
      }
    }
  }

  /// Reports progress as the share of triangles in the parts that were begun.
  void report(std::size_t i) {
    if (!options_.progress) return;
    const std::lock_guard lock(reporting_);
    work_.report("modelling " + scene_.parts[i].part.name,
                 static_cast<double>(begun_) / static_cast<double>(std::max<std::size_t>(1, triangles_)));
    begun_ += scene_.parts[i].part.mesh.triangles.size();
  }

  /// True if the part needs a model, be it only a solid.
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

  /// Gives the part the models of an earlier part of equal geometry.
  void share(std::size_t i) {
    ScenePart& part = scene_.parts[i];
    part.is_cropped = false;
    part.model = std::make_shared<const PartModel>(
        startingModel(part, scene_.parts[*plan_.parts[i].same_as].model.get()));
  }

  Scene& scene_;
  const ModelPlan& plan_;
  const std::vector<std::size_t> parts_;  ///< indices of parts, ascending
  const ModelOptions& options_;
  StoppableWork work_;  ///< lives on the caller's thread, as this object does
  std::vector<BuildTimes> times_;
  std::vector<std::vector<std::string>> warnings_;  ///< warnings of each part
  std::vector<std::exception_ptr> errors_;          ///< error of each part
  std::atomic<std::size_t> first_failed_;  ///< first part with an error; later parts need not be begun
  std::mutex reporting_;
  std::size_t triangles_ = 0, begun_ = 0;
};

}  // namespace

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
                    "needs an automatic fidelity, which was not chosen yet; call resolveFidelity() first");
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

}  // namespace vps::scenes
