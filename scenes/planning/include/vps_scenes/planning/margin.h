// SPDX-License-Identifier: BSD-3-Clause
// How much room each step of a procedure has: in size, in position and in angle of its part.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/verdict.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct MarginOptions : ModelOptions {
  double resolution_m = 1e-6;  ///< of the growth: the bisection ends at this width
  /// False: only by geometry, without a run of the hand. The growth is then an upper bound.
  bool has_contact = true;
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early, between two runs; throws nothing
};

/// Of one step, with the parts that are in place by then as drawn.
struct StepMargin {
  std::size_t step = 0;  ///< index in Scene::steps
  std::string part;
  bool goes = false;  ///< as drawn
  /// Greatest outward offset of all its faces with which it was seen to go: half of the growth in diameter.
  double growth_m = 0;
  /// Least one with which it does not; none if it goes at the greatest one that was looked at, growth_m.
  std::optional<double> growth_fails_m;
  Verdict fails_as = Verdict::Fits;  ///< with that growth, or as drawn; Fits: it does not fail
  std::string fails_why;
  /// By geometry alone: greatest offset that no overlap and no fit rules out.
  double growth_bound_m = 0;
  /// Least displacement along an axis of its play (check.h) across the path that makes it touch at its
  /// target, off its seat, and its direction; between the axes it may be less, by up to a factor of sqrt(2)
  /// for flat walls. None: it overlaps there, or nothing is beside it.
  std::optional<double> position_m;
  Vec3 position_W = Vec3::Zero();
  double position_error_m = 0;
  std::optional<double> angle_rad;  ///< the same for a rotation about an axis across the path
  double angle_error_rad = 0;
  std::size_t checks = 0, runs = 0;  ///< what it took
};

struct MarginResult {
  std::string scene;
  double resolution_m = 0;
  bool has_contact = true;
  std::vector<StepMargin> steps;  ///< those that do not go as drawn first, then by growth
};

/// Measures each step by itself, with the part of the step offset by shrunkMesh() and all others as drawn.
/// First geometry bounds the growth; then runs of the virtual operator with the scene's seed look for the
/// greatest growth within it that is brought home. Bisection takes it that a larger part does not go where a
/// smaller one did not. Growth is looked at up to a twentieth of the part's least extent. Throws as
/// assemble().
VPS_SCENES_API MarginResult measureMargins(const Scene& scene, const MarginOptions& options = {});

}  // namespace vps::scenes
