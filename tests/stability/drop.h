// SPDX-License-Identifier: BSD-3-Clause
// The scene of most rows: a tilted block falls on a plate, topples and comes to rest.
#pragma once

#include "row.h"
#include "watch.h"

namespace vps::stability {

struct Drop {
  double size = 1;         ///< times a steel block of 20 x 15 x 10 mm, on a plate of 60 x 60 x 10 mm
  double plate_m = 10e-3;  ///< thickness, before size
  double voxel_m = 0.5e-3, spacing_m = 1e-3;  ///< before size
  Vec3 tilt_rad = Vec3(0.1, 0.06, 0.2);       ///< rotation vector
  double fall_m = 1e-3;                       ///< of the lowest corner, before size
  double speed_m_s = 0;                       ///< downwards, when let go
  double friction = 0.15;
  double dt_s = 1e-3;
  double duration_s = 0.5;
  bullet::Settings settings;
  Pose X_WS;  ///< the whole scene, gravity too
  /// The scene in a mirror: x to -x of the scene's frame, meshes too.
  bool is_mirrored = false;
  std::function<double(int)> step_s = nullptr;  ///< instead of dt_s, where it changes
};

struct Dropped {
  Watched watched;
  double weight_N = 0;
  double mass_kg = 0;
  double start_m = 0;           ///< of the block's centre over the plate
  double end_m = 0;             ///< at the end
  std::vector<Pose> X_SB_path;  ///< every tenth step; of a mirrored scene as the mirror shows it
};

Dropped drop(Mode mode, const Drop& what);

/// How deep the block may press: in rigid contact a corner turns by up to v dt within a step, of which
/// (v dt)^2 / 2 r is off the tangent, r the least half side; and a micrometre. Springs take up the fall's
/// energy E in the end by one corner, which stands for a quarter of a point's square: d^2 = 2 E / (k A).
double allowedDepth_m(Mode mode, const Drop& what, const Dropped& dropped);

/// Numbers, energy, overlap, rest, and that it lies on the plate.
Judgement judgeDrop(Mode mode, const Drop& what);

}  // namespace vps::stability
