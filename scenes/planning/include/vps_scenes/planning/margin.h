// SPDX-License-Identifier: BSD-3-Clause
// Margins of each step of a procedure: in size, in position and in angle of its part.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct MarginOptions : ModelOptions {
  double resolution_m = 1e-6;  ///< width of the growth interval at which the bisection ends
  /// False: geometry alone decides, without a run of the virtual hand; the growth is then an upper bound.
  bool has_contact = true;
  const std::atomic<bool>* stop =
      nullptr;  ///< the caller sets the flag to end early, between two runs; an early end throws nothing
};

/// Margins of one step, where the parts that are in place before the step are as drawn.
struct StepMargin {
  std::size_t step = 0;  ///< index in Scene::steps
  std::string part;
  bool goes = false;  ///< the step succeeds with the part as drawn
  /// Greatest outward offset of all faces of the part with which the step succeeded: half of the growth in
  /// diameter.
  double growth_m = 0;
  /// Least offset with which the step fails; none if the step succeeds at growth_m, the greatest offset that
  /// was tried.
  std::optional<double> growth_fails_m;
  Verdict fails_as = Verdict::Fits;  ///< verdict with growth_fails_m, or as drawn; Fits: no failure was found
  std::string fails_why;
  /// Greatest offset that geometry alone allows: no overlap and no fit rules it out.
  double growth_bound_m = 0;
  /// Least displacement at the target that makes the part, lifted off its seat, touch another part. Only
  /// displacements along the play axes (check.h) across the path are tried; between the axes the least
  /// displacement may be smaller by up to a factor of sqrt(2) for flat walls. None: the part overlaps another
  /// part at its target, or no displacement makes it touch.
  std::optional<double> position_m;
  /// Direction of the displacement position_m.
  Vec3 position_W = Vec3::Zero();
  double position_error_m = 0;
  std::optional<double> angle_rad;  ///< least rotation about an axis across the path that makes the part
                                    ///< touch; none: as for position_m
  double angle_error_rad = 0;
  std::size_t checks = 0, runs = 0;  ///< exact measurements and runs that the step took
};

struct MarginResult {
  std::string scene;
  double resolution_m = 0;
  bool has_contact = true;
  std::vector<StepMargin> steps;  ///< steps that fail as drawn first, then in order of growth_m
  /// The worst verdict of the steps as drawn; NotShown if no step was measured.
  [[nodiscard]] VPS_SCENES_API Verdict verdict() const;
};

/// Measures each step by itself, with the part of the step offset by shrunkMesh() and all other parts as
/// drawn. First geometry bounds the growth; then runs of the virtual operator with the scene's seed look for
/// the greatest growth within this bound with which the step succeeds. The bisection assumes that a part
/// fails if the same part with a smaller offset failed. Growth is tried up to a twentieth of the part's least
/// extent. Throws as assemble().
VPS_SCENES_API MarginResult measureMargins(const Scene& scene, const MarginOptions& options = {});

}  // namespace vps::scenes
