// SPDX-License-Identifier: BSD-3-Clause
// Pointshells of a running simulation at another spacing, for load shedding. Any thread can make them.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "models/fixed_field.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Pointshells that replace the parts' own shells, by part; null: the part keeps its own shell.
using ShellSet = std::vector<std::shared_ptr<const PointShell>>;

/// Builds a shell at `coarser` times the scene's spacing for every part that has a shell, cropped according
/// to the plan. Throws as buildPointShell() does, and std::runtime_error once `stop` (may be null) is set.
std::shared_ptr<const ShellSet> coarserShells(const Scene& scene, const ModelPlan& plan, double coarser,
                                              const std::atomic<bool>* stop);

/// The body and the fixed field whose shells are to be replaced.
struct ResampleOrder {
  FieldOrder field;  ///< has the current map as `below`, and the parts' own shells; no parts: no field
  std::size_t part = 0;
  std::shared_ptr<const PartModel> model;                       ///< model of the body, with its own shell
  Pose X_SM;                                                    ///< pose of the model in the body's Shape
  std::shared_ptr<const PointShell> field_before, part_before;  ///< shells in use; field_before may be null
  Pose X_WP;  ///< pose of the part at which distances are compared
  Sides sides = Sides::Both;
};

struct ResampledShells {
  std::shared_ptr<const ShellSet> shells;  ///< null: the parts' own shells
  std::optional<CookedField> field;
  std::size_t part = 0;
  std::unique_ptr<bullet::Shape> shape;
  /// Change of the least distance at ResampleOrder::X_WP by the new shells: the new distance minus the
  /// distance before. None if one of the two distances is beyond the map's band.
  std::optional<double> misread_m;
};

/// Makes body and field with other shells and the same maps. The same input gives the same bits. Throws as
/// cookField() does, and std::runtime_error if cookField() was stopped.
ResampledShells resampleShells(ResampleOrder order, std::shared_ptr<const ShellSet> shells);

}  // namespace vps::scenes
