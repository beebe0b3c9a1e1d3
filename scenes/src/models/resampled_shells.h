// SPDX-License-Identifier: BSD-3-Clause
// The models of a running simulation once more, with points that lie closer or farther apart; made on any
// thread.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "models/fixed_field.h"
#include "vps_scenes/plan.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// Points that stand in for the parts' own, by part; null: its own.
using ShellSet = std::vector<std::shared_ptr<const PointShell>>;

/// For every part that has a shell, one at so many times the scene's spacing, cropped as the plan says. O(as
/// building them). Throws as buildPointShell(), and std::runtime_error once `stop` (may be null) is set.
std::shared_ptr<const ShellSet> coarserShells(const Scene& scene, const Plan& plan, double coarser,
                                              const std::atomic<bool>* stop);

/// What is to be made again: a body, and the field in place where there is one.
struct ResampleOrder {
  FieldOrder field;  ///< with the map in place as `below`, and the parts' own points; without parts: none
  std::size_t part = 0;
  bullet::ShapeModels models;                                   ///< with its own points
  Pose X_SM;                                                    ///< Shape's
  std::shared_ptr<const PointShell> field_before, part_before;  ///< in use; the field's may be null
  Pose X_WP;                                                    ///< of the part, to compare readings at
  Sides sides = Sides::Both;
};

struct ResampledShells {
  std::shared_ptr<const ShellSet> shells;  ///< null: the parts' own
  std::optional<CookedField> field;
  std::size_t part = 0;
  std::unique_ptr<bullet::Shape> shape;
  /// Least distance as they read it at ResampleOrder::X_WP, less that of the points before; none where either
  /// is beyond the map's band.
  std::optional<double> misread_m;
};

/// The maps stay those in place. Same input, same bits. Throws as cookField(), and std::runtime_error
/// where that was stopped.
ResampledShells resampleShells(ResampleOrder order, std::shared_ptr<const ShellSet> shells);

}  // namespace vps::scenes
