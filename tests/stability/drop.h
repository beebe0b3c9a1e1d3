// SPDX-License-Identifier: BSD-3-Clause
// Steel blocks and plates with coarse models, and the scene of most rows: a tilted block falls on a plate,
// topples and comes to rest.
#pragma once

#include "dynamics/world.h"
#include "rows.h"
#include "watch.h"

namespace vps::stability {

using dynamics::makePart;
using dynamics::PartMesh;
using dynamics::World;

inline constexpr double kGravity_m_s2 = World::kGravity_m_s2;
inline constexpr double kVoxel_m = 0.5e-3;
inline constexpr double kPlate_m = 60e-3;  ///< side of a plate
inline constexpr double kThick_m = 10e-3;  ///< thickness of a plate
inline const dynamics::Resolution kCoarse{kVoxel_m, 1e-3};
inline const Vec3 kBlock_m(20e-3, 15e-3, 10e-3);

inline PartMesh block() {
  return makePart(makeBox(kBlock_m));
}

inline PartMesh plate(double side_m = kPlate_m) {
  return makePart(makeBox(Vec3(side_m, side_m, kThick_m)));
}

struct Drop {
  double size = 1;  ///< factor of all lengths: a steel block of 20 x 15 x 10 mm on a plate of 60 x 60 x 10 mm
  double plate_m = 10e-3;                     ///< thickness of the plate, to be multiplied by size
  double voxel_m = 0.5e-3, spacing_m = 1e-3;  ///< to be multiplied by size
  Vec3 tilt_rad = Vec3(0.1, 0.06, 0.2);       ///< rotation vector
  double fall_m = 1e-3;                       ///< height of the lowest corner, to be multiplied by size
  double speed_m_s = 0;                       ///< downwards, at the start
  double friction = 0.15;
  double dt_s = 1e-3;
  double duration_s = 0.5;
  bullet::Settings settings;
  Pose X_WS;  ///< pose of the whole scene, including gravity
  /// Mirrors the scene, including meshes: x to -x of the scene's frame.
  bool is_mirrored = false;
  std::function<double(int)> step_s = nullptr;  ///< variable time step, instead of dt_s
};

struct Dropped {
  Watched watched;
  double weight_N = 0;
  double mass_kg = 0;
  double start_m = 0;           ///< height of the block's centre above the plate
  double end_m = 0;             ///< height of the block's centre above the plate at the end
  std::vector<Pose> X_SB_path;  ///< pose of the block after every tenth step; if is_mirrored, mirrored back
};

Dropped drop(Mode mode, const Drop& what);

/// Allowed overlap of the block. Constraint contact: a corner turns by up to v dt within a step and leaves
/// the tangent by (v dt)^2 / 2 r, with r half the shortest side; plus a micrometre. Penalty contact: in the
/// worst case one corner, with a quarter of a point's area, absorbs the energy E of the fall: d^2 = 2 E / (k
/// A).
double allowedDepth_m(Mode mode, const Drop& what, const Dropped& dropped);

/// Judges finite values, energy, overlap, rest, and that the block lies on the plate.
Judgement judgeDrop(Mode mode, const Drop& what);

}  // namespace vps::stability
