// SPDX-License-Identifier: BSD-3-Clause
#include "hand_scenes.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "support/lathe.h"
#include "support/screw.h"
#include "vps_scenes/cad/import.h"

namespace vps::hand {

namespace {

constexpr double kPitch_m = 3e-3, kRod_m = 15e-3, kNut_m = 6e-3;

test::ThreadShape coarse(double length_m, double clearance_m) {
  test::ThreadShape thread;
  thread.major_m = 6e-3;
  thread.pitch_m = kPitch_m;
  thread.length_m = length_m;
  thread.clearance_m = clearance_m;
  thread.chamfer_m = 1.4e-3;  // ends a little below the root, as turned on a lathe
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  thread.face_steps = 4;
  thread.side_steps = 6;
  return thread;
}

/// A scene of a rod and a nut. Both meshes are centred at the origin, where their threads are in phase.
scenes::Scene threadScene(const std::string& name, Mesh rod, Mesh nut, double pitch_m, const Vec3& p_mouth,
                          double depth_m, std::uint64_t seed) {
  constexpr double kStart_m = 4e-3;  // above the mouth
  scenes::Scene scene;
  scene.file = scene.name = name;
  scene.parts.resize(2);
  scene.parts[0].part = {"bolt", std::move(rod), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"nut", std::move(nut), {}, {}};
  scene.steps.resize(1);
  scenes::SceneStep& step = scene.steps[0];
  step.part = 1;
  step.X_WP_target = Pose::translation(p_mouth - Vec3(0, 0, depth_m));
  step.X_WP_start = Pose::translation(p_mouth + Vec3(0, 0, kStart_m));
  step.motion = scenes::StepMotion::Screw;
  step.pitch_m = pitch_m;
  step.timeout_s = 60;
  scene.release_s = 0.1;
  scene.hand.seed = seed;
  scene.fidelity.voxel_m = 0.15e-3;
  scene.fidelity.spacing_m = 0.4e-3;
  return scene;
}

constexpr double kMouth_m = 0.5 * (kRod_m + kNut_m);

}  // namespace

scenes::Scene coarseThread(double depth_m, std::uint64_t seed) {
  return threadScene("coarse_thread", test::makeThreadedRod(coarse(kRod_m, 0)),
                     test::makeNut(coarse(kNut_m, 0.15e-3), 11e-3), kPitch_m, {0, 0, kMouth_m}, depth_m,
                     seed);
}

scenes::Scene leaningNut(double depth_m, std::uint64_t seed) {
  scenes::Scene scene = coarseThread(depth_m, seed);
  scene.hand.aim_error_rad = 0.1;
  return scene;
}

scenes::Scene smoothRod(double depth_m, std::uint64_t seed) {
  constexpr double kRadius_m = 4e-3;  // within the nut's thread
  return threadScene(
      "smooth_rod",
      test::lathe({{0, -kRod_m / 2}, {kRadius_m, -kRod_m / 2}, {kRadius_m, kRod_m / 2}, {0, kRod_m / 2}}, 64),
      test::makeNut(coarse(kNut_m, 0.15e-3), 11e-3), kPitch_m, {0, 0, kMouth_m}, depth_m, seed);
}

scenes::Scene looseM16(double depth_m, std::uint64_t seed) {
  const char* folder = std::getenv("VPS_CAD_DIR");
  const std::filesystem::path from =
      std::filesystem::path(folder != nullptr ? folder : "../shared/cad") / "thread-m16-loose";
  scenes::ImportSettings metres;
  metres.unit_m = 1;
  const auto meshOf = [&](const char* file) {
    return scenes::importCad((from / file).string(), metres).parts.at(0).mesh;
  };
  constexpr double kBoltTop_m = 41e-3, kNutBottom_m = 16e-3, kM16Pitch_m = 2e-3;
  scenes::Scene scene =
      threadScene("m16", meshOf("factory_bolt_m16_loose.obj"), meshOf("factory_nut_m16_loose_subdiv_3x.obj"),
                  kM16Pitch_m, {0, 0, kBoltTop_m - kNutBottom_m}, depth_m, seed);
  scene.steps[0].timeout_s = 300;  // a turn takes some 40 s
  return scene;
}

const std::vector<PegScene>& threadScenes() {
  static const std::vector<PegScene> scenes = {
      {"coarse_thread", "12 mm, pitch 3 mm, 0.15 mm of radial clearance: two turns",
       [](std::uint64_t seed) { return coarseThread(7.5e-3, seed); }},
      {"leaning_nut", "coarse_thread, aimed with a standard deviation of six degrees",
       [](std::uint64_t seed) { return leaningNut(4.5e-3, seed); }},
      {"smooth_rod", "the same nut over a rod without a thread: nothing catches",
       [](std::uint64_t seed) { return smoothRod(7.5e-3, seed); }},
      {"m16", "M16 x 2 of $VPS_CAD_DIR/thread-m16-loose: ten millimetres down the thread",
       [](std::uint64_t seed) { return looseM16(11e-3, seed); }}};
  return scenes;
}

}  // namespace vps::hand
