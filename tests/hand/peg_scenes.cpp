// SPDX-License-Identifier: BSD-3-Clause
#include "peg_scenes.h"

#include <cmath>
#include <numbers>

#include "support/lathe.h"

namespace vps::hand {

namespace {

using Profile = std::vector<std::array<double, 2>>;

constexpr int kFlats = 128;

/// The profile turned into a square tube of the same half widths: its corners stand at 45 degrees.
Mesh squareLathe(Profile profile) {
  for (auto& [r, z] : profile) r *= std::numbers::sqrt2;
  const double eighth_rad = std::numbers::pi / 4;
  return transformed(test::lathe(profile, 4),
                     Pose(rotationFromVector(Vec3(0, 0, eighth_rad)), Vec3(Vec3::Zero())));
}

scenes::Scene scene(const char* name, Mesh hole, Mesh peg, double depth_m, std::uint64_t seed) {
  scenes::Scene scene;
  scene.file = scene.name = name;
  scene.parts.resize(2);
  scene.parts[0].part = {"hole", std::move(hole), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"peg", std::move(peg), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, -depth_m});
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 8e-3});
  scene.steps[0].timeout_s = 40;
  scene.release_s = 0.1;
  scene.hand.seed = seed;
  return scene;
}

scenes::Scene roundPeg(std::uint64_t seed) {
  constexpr double kRadius_m = 4e-3, kBore_m = kRadius_m + 10e-6, kChamfer_m = 0.5e-3, kDepth_m = 10e-3,
                   kLength_m = 25e-3;
  // The hole's flats touch its circle from outside, the peg's corners lie on its own: the clearance is 20 um
  // and never less.
  const double out = 1 / std::cos(std::numbers::pi / kFlats);
  const Profile cup = {{0, -15e-3},
                       {12e-3, -15e-3},
                       {12e-3, 0},
                       {out * (kBore_m + kChamfer_m), 0},
                       {out * kBore_m, -kChamfer_m},
                       {out * kBore_m, -kDepth_m},
                       {0, -kDepth_m}};
  const Profile peg = {
      {0, 0}, {kRadius_m - kChamfer_m, 0}, {kRadius_m, kChamfer_m}, {kRadius_m, kLength_m}, {0, kLength_m}};
  scenes::Scene made = scene("round", test::lathe(cup, kFlats), test::lathe(peg, kFlats), kDepth_m, seed);
  made.steps[0].clearance_m = 20e-6;
  return made;
}

scenes::Scene rectangularPeg(std::uint64_t seed) {
  constexpr double kHalf_m = 2e-3, kHole_m = kHalf_m + 50e-6, kDepth_m = 8e-3, kLength_m = 20e-3;
  const Profile cup = {{0, -12e-3},  {8e-3, -12e-3},       {8e-3, 0},
                       {kHole_m, 0}, {kHole_m, -kDepth_m}, {0, -kDepth_m}};
  const Profile peg = {{0, 0}, {kHalf_m, 0}, {kHalf_m, kLength_m}, {0, kLength_m}};
  scenes::Scene made = scene("rectangular", squareLathe(cup), squareLathe(peg), kDepth_m, seed);
  made.steps[0].clearance_m = 100e-6;
  return made;
}

}  // namespace

const std::vector<PegScene>& pegScenes() {
  static const std::vector<PegScene> scenes = {
      {"round", "8 mm round peg, 20 um of clearance, chamfered", roundPeg},
      {"rectangular", "4 mm square peg, 50 um on each side, sharp", rectangularPeg}};
  return scenes;
}

}  // namespace vps::hand
