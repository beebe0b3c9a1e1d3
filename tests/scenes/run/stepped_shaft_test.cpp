// SPDX-License-Identifier: BSD-3-Clause
// A ring that has to pass one land of a shaft before it reaches its own land.
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>

#include "scenes/scene_part.h"
#include "support/lathe.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

constexpr int kShaftFlats = 96;
constexpr double kLand_m = 16e-3, kRingHole_m = 16.025e-3, kNeck_m = 15e-3;

/// The lands are 20 mm long and 25 mm apart, with sharp edges; the ring rests on a collar below the second
/// one.
Scene ringOverTwoLands(std::uint64_t seed) {
  const Mesh shaft = test::lathe({{0, -30e-3},
                                  {25e-3, -30e-3},
                                  {25e-3, 0},
                                  {kLand_m, 0},
                                  {kLand_m, 20e-3},
                                  {kNeck_m, 20e-3},
                                  {kNeck_m, 45e-3},
                                  {kLand_m, 45e-3},
                                  {kLand_m, 65e-3},
                                  {0, 65e-3}},
                                 kShaftFlats);
  const Mesh ring =
      test::lathe({{kRingHole_m, 0}, {24e-3, 0}, {24e-3, 12e-3}, {kRingHole_m, 12e-3}}, kShaftFlats);
  Scene scene;
  scene.file = scene.name = "stepped_shaft";
  scene.parts = {scenePart("shaft", shaft, Vec3::Zero(), true), scenePart("ring", ring, Vec3::Zero(), false)};
  SceneStep step;
  step.part = 1;
  step.X_WP_target = step.X_WP_start = scene.parts[1].X_WP;
  step.X_WP_start.p.z() = 68e-3;
  step.timeout_s = 40;
  scene.steps.push_back(step);
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 500;
  scene.release_s = 0.2;
  scene.hand.seed = seed;
  return scene;
}

TEST(SteppedShaft, TakesARingOverItsFirstLandToItsSecond) {
  // With one of sixty aims, the ring is not yet pressed to its target when the time is over; which aim is
  // late changes with any change of rounding.
  constexpr std::uint64_t kAims = 8, kMostLate = 1;
  std::uint64_t late = 0;
  std::ostringstream said;
  for (std::uint64_t seed = 1; seed <= kAims; ++seed) {
    Scene scene = ringOverTwoLands(seed);
    // The penetration at the sharp edges of the lands is not checked here.
    const StepResult step = assemble(scene).steps[0];
    if (step.completed && step.by_contact) continue;
    said << "aim " << seed << ": " << step.reason << ": ";
    for (const auto& span : step.strategies)
      said << span.strategy << ' ' << span.start_s << '+' << span.duration_s << "; ";
    const auto isSaid = [&](const char* words) { return step.reason.find(words) != std::string::npos; };
    EXPECT_TRUE(
        isSaid("gave up after its time was over") ||
        isSaid("the step's time (timeout_s) was over before the hand had pressed the part to its target"))
        << said.str();
    ++late;
  }
  EXPECT_LE(late, kMostLate) << said.str();
}

}  // namespace
}  // namespace vps::scenes
