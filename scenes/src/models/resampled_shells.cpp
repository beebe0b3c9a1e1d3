// SPDX-License-Identifier: BSD-3-Clause
#include "models/resampled_shells.h"

#include <algorithm>
#include <stdexcept>

#include "models/scene_models.h"
#include "vps/query.h"
#include "vps/shell_crop.h"

namespace vps::scenes {

namespace {

std::shared_ptr<const PointShell> coarser(const Part& part, const PlannedPart& planned,
                                          PointShellSettings settings) {
  auto shell = std::make_shared<PointShell>(buildPointShell(part.mesh, settings, part.name));
  if (planned.kept_P.empty()) return shell;
  return std::make_shared<PointShell>(croppedShell(*shell, planned.kept_P));
}

struct Side {
  const VoxMap* map = nullptr;
  const PointShell* shell = nullptr;
};

/// Least distance of a part to the field, which lies in W; none beyond the band.
std::optional<double> leastDistance(const Side& field, const Side& part, const Pose& X_WP, Sides sides) {
  std::optional<double> least_m;
  const auto ask = [&](const Side& of, const Side& to, const Pose& X) {
    if (to.map == nullptr || of.shell == nullptr) return;
    const QueryResult result = queryDistance(*to.map, *of.shell, X);
    if (result.status == Status::Ok)
      least_m = std::min(least_m.value_or(result.min_distance_m), result.min_distance_m);
  };
  ask(part, field, X_WP);
  if (sides == Sides::Both) ask(field, part, X_WP.inverse());
  return least_m;
}

}  // namespace

std::shared_ptr<const ShellSet> coarserShells(const Scene& scene, const Plan& plan, double by,
                                              const std::atomic<bool>* stop) {
  PointShellSettings settings = pointShellSettings(scene.fidelity);
  settings.spacing_m *= by;
  auto shells = std::make_shared<ShellSet>(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (stop != nullptr && stop->load()) throw std::runtime_error("the run was stopped");
    const auto same_as = plan.parts[i].same_as;
    if (same_as)
      (*shells)[i] = (*shells)[*same_as];
    else if (scene.parts[i].part.shell)
      (*shells)[i] = coarser(scene.parts[i].part, plan.parts[i], settings);
  }
  return shells;
}

ResampledShells resampleShells(ResampleOrder order, std::shared_ptr<const ShellSet> shells) {
  const auto use = [&](std::size_t part, std::shared_ptr<const PointShell>& shell) {
    if (shells && shell && (*shells)[part]) shell = (*shells)[part];
  };
  for (FieldPart& part : order.field.parts) use(part.placed.part, part.shell);
  use(order.part, order.models.shell);

  ResampledShells out;
  Side field{order.field.below.get(), order.field_before.get()};
  Side part{order.models.map.get(), order.part_before.get()};
  const auto before_m = leastDistance(field, part, order.X_WP, order.sides);
  if (!order.field.parts.empty()) {
    out.field = cookField(order.field);
    if (!out.field->shape) throw std::runtime_error("the run was stopped");
    field.shell = out.field->shape->models().shell.get();
  }
  part.shell = order.models.shell.get();
  const auto after_m = leastDistance(field, part, order.X_WP, order.sides);
  if (before_m && after_m) out.misread_m = *after_m - *before_m;

  out.part = order.part;
  out.shape = std::make_unique<bullet::Shape>(std::move(order.models), order.X_SM);
  out.shells = std::move(shells);
  return out;
}

}  // namespace vps::scenes
