// SPDX-License-Identifier: BSD-3-Clause
// A peg in a blind hole, with given radii, for tests of margins and studies.
#pragma once

#include "scenes/scene_part.h"
#include "support/lathe.h"

namespace vps::scenes {

/// Sizes of a peg and its cup [m]. Both have the same number of aligned flats, with corners at the radii; 4
/// flats make a square key in a square pocket.
struct PegInCup {
  double bore_m = 4.05e-3, peg_m = 4e-3;
  int flats = 96;
  double depth_m = 10e-3, length_m = 15e-3, chamfer_m = 0.5e-3;
};

/// The peg stands on the bottom of the cup, z = -depth, and comes from straight above.
inline Scene pegInCup(const PegInCup& of) {
  const double wall_m = 9e-3, floor_m = of.depth_m + 4e-3;
  const Mesh cup = test::lathe({{0, -floor_m},
                                {wall_m, -floor_m},
                                {wall_m, 0},
                                {of.bore_m + of.chamfer_m, 0},
                                {of.bore_m, -of.chamfer_m},
                                {of.bore_m, -of.depth_m},
                                {0, -of.depth_m}},
                               of.flats);
  const Mesh peg = test::lathe({{0, 0},
                                {of.peg_m - of.chamfer_m, 0},
                                {of.peg_m, of.chamfer_m},
                                {of.peg_m, of.length_m},
                                {0, of.length_m}},
                               of.flats);
  Scene scene;
  scene.file = scene.name = "peg_in_cup";
  scene.parts = {scenePart("cup", cup, Vec3::Zero(), true),
                 scenePart("peg", peg, {0, 0, -of.depth_m}, false)};
  SceneStep step;
  step.part = 1;
  step.X_WP_target = scene.parts[1].X_WP;
  step.X_WP_start = step.X_WP_target;
  step.X_WP_start.p.z() += of.depth_m + 1e-3;
  step.timeout_s = 10;
  scene.steps.push_back(step);
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.2;
  scene.hand.aim_error_m = scene.hand.aim_error_rad = 0;
  return scene;
}

}  // namespace vps::scenes
