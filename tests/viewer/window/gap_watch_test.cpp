// SPDX-License-Identifier: BSD-3-Clause
#include "run/gap_watch.h"

#include <gtest/gtest.h>

#include <chrono>

namespace vps::viewer {
namespace {

using namespace std::chrono_literals;

/// A plate of 100 x 100 x 20 mm about the origin and a cube of 20 mm.
scenes::Scene plateAndCube() {
  scenes::Scene scene;
  for (const char* name : {"plate", "cube"}) {
    scenes::ScenePart part;
    part.part.name = name;
    part.part.mesh = makeBox(scene.parts.empty() ? Vec3(0.1, 0.1, 0.02) : Vec3(0.02, 0.02, 0.02));
    scene.parts.push_back(part);
  }
  return scene;
}

scenes::Snapshot cubeAt(double height_m, double time_s) {
  scenes::Snapshot shot;
  shot.time_s = time_s;
  shot.bodies = {{0, {}, scenes::BodyRole::Mounted},
                 {1, Pose::translation(Vec3(0, 0, 0.02 + height_m)), scenes::BodyRole::InHand}};
  return shot;
}

/// Waits for the measurement of the given snapshot, for at most a minute.
MeasuredGaps measuredAt(const GapWatch& watch, std::size_t part, double time_s) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < end) {
    const std::optional<MeasuredGaps> found = watch.of(part);
    if (found && found->time_s == time_s) return *found;
    std::this_thread::sleep_for(1ms);
  }
  ADD_FAILURE() << "nothing was measured within a minute";
  return {};
}

TEST(GapWatchTest, TellsHowFarPartsAreAtThePosesThatAreShown) {
  const scenes::Scene scene = plateAndCube();
  GapWatch watch(scene);
  EXPECT_FALSE(watch.of(1));
  watch.request(cubeAt(30e-6, 1), {1});
  EXPECT_EQ(gapLines(scene, measuredAt(watch, 1, 1)), std::vector<std::string>{"plate: 30 µm away"});
  watch.request(cubeAt(2e-3, 2), {1});
  EXPECT_EQ(gapLines(scene, measuredAt(watch, 1, 2)), std::vector<std::string>{"nothing within 1 mm"});
  scenes::Snapshot pressed = cubeAt(-2e-6, 3);
  pressed.contacts = {{Vec3(0, 0, 0.01), Vec3::UnitZ(), 2e-6, 2.5, Vec3::Zero()}};
  watch.request(pressed, {1, 0});
  EXPECT_EQ(gapLines(scene, measuredAt(watch, 1, 3)),
            std::vector<std::string>{"plate: touches this part, 2.5 N"});
  EXPECT_EQ(gapLines(scene, measuredAt(watch, 0, 3)),
            std::vector<std::string>{"cube: touches this part, 2.5 N"});
}

TEST(GapWatchTest, EndsWhileSomethingIsWanted) {
  const scenes::Scene scene = plateAndCube();
  for (int i = 0; i < 3; ++i) {
    GapWatch watch(scene);
    watch.request(cubeAt(1e-4, i), {1});
  }
}

}  // namespace
}  // namespace vps::viewer
