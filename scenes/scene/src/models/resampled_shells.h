// SPDX-License-Identifier: BSD-3-Clause
// The pointshells of a running simulation at another spacing, for load shedding. They are made on any thread.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "models/fixed_field.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Pointshells that replace the parts' own, by part; null: the part's own is used.
using ShellSet = std::vector<std::shared_ptr<const PointShell>>;

/// For every part that has a shell, one at `coarser` times the scene's spacing, cropped as the plan says.
/// Takes as long as building them. Throws as buildPointShell(), and std::runtime_error once `stop` (may be
/// null) is set.
std::shared_ptr<const ShellSet> coarserShells(const Scene& scene, const ModelPlan& plan, double coarser,
                                              const std::atomic<bool>* stop);

/// The body and the fixed field whose shells are to be replaced.
struct ResampleOrder {
  FieldOrder field;  ///< with the map in place as `below`, and the parts' own shells; without parts: no field
  std::size_t part = 0;
  std::shared_ptr<const PartModel> model;                       ///< of the body, with its own shell
  Pose X_SM;                                                    ///< of the body's Shape
  std::shared_ptr<const PointShell> field_before, part_before;  ///< in use; the field's may be null
  Pose X_WP;                                                    ///< of the part, where distances are compared
  Sides sides = Sides::Both;
};

struct ResampledShells {
  std::shared_ptr<const ShellSet> shells;  ///< null: the parts' own
  std::optional<CookedField> field;
  std::size_t part = 0;
  std::unique_ptr<bullet::Shape> shape;
  /// Least distance by the new shells at ResampleOrder::X_WP, less that by the shells before; none where
  /// either is beyond the map's band.
  std::optional<double> misread_m;
};

/// Makes body and field with other shells; the maps stay those in place. Same input, same bits. Throws as
/// cookField(), and std::runtime_error where that was stopped.
ResampledShells resampleShells(ResampleOrder order, std::shared_ptr<const ShellSet> shells);

}  // namespace vps::scenes
