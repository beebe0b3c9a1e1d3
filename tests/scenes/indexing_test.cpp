// SPDX-License-Identifier: BSD-3-Clause
// Paths longer than the device's workspace: their segments, and runs that index between them.
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/path_segments.h"
#include "support/temporary_folder.h"
#include "vps/load_error.h"
#include "vps_device/random.h"
#include "vps_scenes/assemble.h"
#include "vps_scenes/record.h"
#include "vps_scenes/replay.h"

namespace vps::scenes {
namespace {

const Vec3 kWorkspace_m(0.4, 0.6, 0.4);  // the dual arm's

/// A pin that is set down on a plate from a distance of 1 m, with a workspace 0.4 m wide.
Scene farPin() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({10e-3, 10e-3, 2e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"pin", makeBox({2e-3, 2e-3, 2e-3}), {}, {}};
  scene.steps.resize(1);
  SceneStep& step = scene.steps[0];
  step.part = 1;
  step.X_WP_target = Pose::translation({0, 0, 2e-3});
  step.way_points = {Pose::translation({0, 0, 2.2e-3})};
  step.X_WP_start = Pose::translation({1, 0, 50e-3});
  step.timeout_s = 60;
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  scene.hand.aim_error_m = 0.05e-3;
  scene.hand.speed_m_s = 0.3;
  return scene;
}

/// The handle stays within the workspace in each segment, and the segments are joined end to end.
void expectWithinWorkspace(const Scene& scene, const SceneStep& step, const PathSegments& segments) {
  ASSERT_EQ(segments.X_DH_start.size(), segments.index_points.size() + 1);
  const Vec3 p_PG = massProperties(scene.parts[step.part].part.mesh).com;
  std::vector<Pose> path = {step.X_WP_start};
  path.insert(path.end(), segments.way_points.begin(), segments.way_points.end());
  path.push_back(step.X_WP_target);
  std::size_t segment = 0;
  Vec3 p_DH = segments.X_DH_start[0].p;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) p_DH += (path[i] * p_PG - path[i - 1] * p_PG) / scene.device.scale;
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(p_DH[axis]), kWorkspace_m[axis] / 2 + 1e-12) << i;
    if (segment < segments.index_points.size() && i == segments.index_points[segment] + 1)
      p_DH = segments.X_DH_start[++segment].p;
  }
  EXPECT_EQ(segment, segments.index_points.size());
}

TEST(PathSegments, APathThatFitsIsOneSegmentAroundTheMiddle) {
  Scene scene = farPin();
  scene.steps[0].X_WP_start = Pose::translation({0.3, 0, 50e-3});
  const PathSegments segments = splitPath(scene, scene.steps[0], kWorkspace_m);
  EXPECT_TRUE(segments.index_points.empty());
  ASSERT_EQ(segments.way_points.size(), 1u);
  ASSERT_EQ(segments.X_DH_start.size(), 1u);
  EXPECT_NEAR(segments.X_DH_start[0].p.x(), 0.15, 1e-12);
}

TEST(PathSegments, AStraightMetreTakesThreeSegmentsOfAtMostThirtySixCentimetres) {
  // A segment has 0.4 m less 20 mm on each side. The last ones are filled, so the first is the remaining 0.28
  // m.
  const Scene scene = farPin();
  const PathSegments segments = splitPath(scene, scene.steps[0], kWorkspace_m);
  ASSERT_EQ(segments.index_points, (std::vector<std::size_t>{0, 1}));
  EXPECT_NEAR(segments.way_points[0].p.x(), 0.72, 1e-9);
  EXPECT_NEAR(segments.way_points[1].p.x(), 0.36, 1e-9);
  EXPECT_EQ(segments.way_points[2].p, scene.steps[0].way_points[0].p);
  expectWithinWorkspace(scene, scene.steps[0], segments);
}

TEST(PathSegments, AnyPathStaysWithinTheWorkspaceAtAnyScale) {
  device::Random random(5);
  for (int i = 0; i < 200; ++i) {
    Scene scene = farPin();
    SceneStep& step = scene.steps[0];
    scene.device.scale = 0.5 + 2 * random.uniform();
    step.way_points.clear();
    for (int n = i % 5; n > 0; --n) step.way_points.push_back(Pose::translation(random.normal3()));
    step.X_WP_start = Pose(rotationFromVector(random.normal3()), 2 * random.normal3());
    expectWithinWorkspace(scene, step, splitPath(scene, step, kWorkspace_m));
  }
}

TEST(Indexing, APartMovesAMetreWithAWorkspaceOfFortyCentimetres) {
  Scene scene = farPin();
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 1u);
  const StepResult& step = result.steps[0];
  EXPECT_TRUE(step.completed) << step.failure_reason;
  EXPECT_EQ(step.index_count, 2);
  EXPECT_LE(result.energy.injected_J, 1e-3);
  // While the hand returns, the proxy stands still and the part hangs at rest on the coupling.
  int still = 0;
  for (std::size_t i = 1; i < result.trace.size(); ++i)
    still += result.trace[i].X_W_Proxy.p == result.trace[i - 1].X_W_Proxy.p &&
             result.trace[i].X_W_Proxy.p.x() > 0.1;
  EXPECT_GE(still,
            2 * 250);  // two returns of 1.5 s at 250 Hz take 750 steps; the part needs some to come to rest
}

TEST(Indexing, WithoutIndexingTheRunIsRefusedWithARemedy) {
  Scene scene = farPin();
  scene.device.has_indexing = false;
  try {
    assemble(scene);
    FAIL();
  } catch (const LoadError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("longer than the device's workspace of 400 x 600 x 400 mm"), std::string::npos)
        << words;
    EXPECT_NE(words.find("indexing = true"), std::string::npos) << words;
  }
}

TEST(Indexing, ARunWithIndexingReplaysBitForBit) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Scene scene = farPin();
  const AssembleResult result = assembleAndRecord(scene, file);
  const device::RecordedRun run = device::loadRecording(file);
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
  EXPECT_EQ(replayed.result.steps.at(0).index_count, 2);
  EXPECT_EQ(replayed.result.steps[0].final_error_m, result.steps[0].final_error_m);
}

}  // namespace
}  // namespace vps::scenes
