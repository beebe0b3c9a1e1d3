// SPDX-License-Identifier: BSD-3-Clause
#include "models/resampled_shells.h"

#include <algorithm>
#include <stdexcept>

#include "models/scene_models.h"
#include "vps/pointshell.h"
#include "vps/query.h"

namespace vps::scenes {

namespace {

std::shared_ptr<const PointShell> coarserShell(const PartModel& part, const PartModelPlan& planned,
                                               const PointShellSettings& settings) {
  auto shell = std::make_shared<PointShell>(buildPointShell(*part.solid, settings, part.name));
  if (planned.kept_P.empty()) return shell;
  return std::make_shared<PointShell>(croppedShell(*shell, planned.kept_P));
}

struct MapAndShell {
  const VoxMap* map = nullptr;
  const PointShell* shell = nullptr;
};

/// Least distance of a part to the field, whose frame is W; none if the part is beyond the map's band.
std::optional<double> leastDistance(const MapAndShell& field, const MapAndShell& part, const Pose& X_WP,
                                    Sides sides) {
  std::optional<double> least_m;
  const auto query = [&](const MapAndShell& points, const MapAndShell& solid, const Pose& X_SolidPoints) {
    if (solid.map == nullptr || points.shell == nullptr) return;
    const QueryResult result = queryDistance(*solid.map, *points.shell, X_SolidPoints);
    if (result.status == Status::Ok)
      least_m = std::min(least_m.value_or(result.min_distance_m), result.min_distance_m);
  };
  query(part, field, X_WP);
  if (sides == Sides::Both) query(field, part, X_WP.inverse());
  return least_m;
}

}  // namespace

std::shared_ptr<const ShellSet> coarserShells(const Scene& scene, const ModelPlan& plan, double coarser,
                                              const std::atomic<bool>* stop) {
  PointShellSettings settings = pointShellSettings(scene.fidelity);
  settings.spacing_m *= coarser;
  auto shells = std::make_shared<ShellSet>(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (stop != nullptr && stop->load()) throw std::runtime_error("the run was stopped");
    const auto same_as = plan.parts[i].same_as;
    const PartModel* model = scene.parts[i].model.get();
    if (same_as)
      (*shells)[i] = (*shells)[*same_as];
    else if (model != nullptr && model->shell)
      (*shells)[i] = coarserShell(*model, plan.parts[i], settings);
  }
  return shells;
}

ResampledShells resampleShells(ResampleOrder order, std::shared_ptr<const ShellSet> shells) {
  const auto replaceShell = [&](std::size_t part, std::shared_ptr<const PartModel>& model) {
    if (shells && model->shell && (*shells)[part]) model = withShell(*model, (*shells)[part]);
  };
  for (FieldPart& part : order.field.parts) replaceShell(part.placed.part, part.model);
  replaceShell(order.part, order.model);

  ResampledShells out;
  MapAndShell field{order.field.below.get(), order.field_before.get()};
  MapAndShell part{order.model->map.get(), order.part_before.get()};
  const auto before_m = leastDistance(field, part, order.X_WP, order.sides);
  if (!order.field.parts.empty()) {
    out.field = cookField(order.field);
    if (!out.field->shape) throw std::runtime_error("the run was stopped");
    field.shell = out.field->shape->models().shell.get();
  }
  part.shell = order.model->shell.get();
  const auto after_m = leastDistance(field, part, order.X_WP, order.sides);
  if (before_m && after_m) out.misread_m = *after_m - *before_m;

  out.part = order.part;
  out.shape = std::make_unique<bullet::Shape>(shapeModels(*order.model), order.X_SM);
  out.shells = std::move(shells);
  return out;
}

}  // namespace vps::scenes
