// SPDX-License-Identifier: BSD-3-Clause
#include "rod_scenes.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "support/lathe.h"

namespace vps::hand {

namespace {

constexpr double kRod_m = 5e-3, kLength_m = 200e-3;
constexpr double kWall_m = 10e-3, kOuter_m = 15e-3, kBetween_m = 150e-3;

/// From z = 0 to kWall_m. Its flats touch the circle of the hole from outside.
Mesh wallMesh(double bore_m) {
  const double in_m = bore_m / std::cos(std::numbers::pi / kFlats);
  return test::lathe({{in_m, 0}, {kOuter_m, 0}, {kOuter_m, kWall_m}, {in_m, kWall_m}}, kFlats);
}

Mesh rodMesh() {
  return test::lathe({{0, 0}, {kRod_m, 0}, {kRod_m, kLength_m}, {0, kLength_m}}, kFlats);
}

}  // namespace

scenes::Scene levelRod(double clearance_m, std::uint64_t seed) {
  constexpr double kOut_m = 20e-3;  // of the rod, beyond each wall; and before the first one at the start
  const Mat3 along_x = rotationFromVector(Vec3(0, std::numbers::pi / 2, 0));
  scenes::Scene scene;
  scene.file = scene.name = "level rod";
  scene.parts.resize(3);
  const Mesh wall = wallMesh(kRod_m + 0.5 * clearance_m);
  for (std::size_t i = 0; i < 2; ++i) {
    scene.parts[i].part = {i == 0 ? "near wall" : "far wall", wall, {}, {}};
    scene.parts[i].X_WP = Pose(along_x, Vec3(i == 0 ? 0 : kWall_m + kBetween_m, 0, 0));
    scene.parts[i].is_fixed = true;
  }
  scene.parts[2].part = {"rod", rodMesh(), {}, {}};
  scene.steps.resize(1);
  scenes::SceneStep& step = scene.steps[0];
  step.part = 2;
  step.X_WP_target = Pose(along_x, Vec3(kBetween_m + 2 * kWall_m + kOut_m - kLength_m, 0, 0));
  step.X_WP_start = Pose(along_x, Vec3(-kOut_m - kLength_m, 0, 0));
  step.timeout_s = 60;
  scene.release_s = 0.5;
  scene.hand.seed = seed;
  return scene;
}

const std::vector<PegScene>& rodScenes() {
  static const std::vector<PegScene> scenes = {
      {"level_rod", "10 x 200 mm level rod through two walls, 50 um of clearance, sharp",
       [](std::uint64_t seed) { return levelRod(50e-6, seed); }}};
  return scenes;
}

}  // namespace vps::hand
