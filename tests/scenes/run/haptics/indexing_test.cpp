// SPDX-License-Identifier: BSD-3-Clause
// Paths that are longer, or turn farther, than the device's workspace: their segments, and runs that index
// between them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptics/path_segments.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/random.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

const Vec3 kWorkspace_m(0.4, 0.6, 0.4);  // the dual arm's
const Workspace kWorkspace{kWorkspace_m, 0.78};

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
  step.tolerance_m = 0.5e-3;  // nothing guides the pin across: five standard deviations of sight
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
  Mat3 R_DH = segments.X_DH_start[0].R;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) p_DH += (path[i] * p_PG - path[i - 1] * p_PG) / scene.device.scale;
    if (i > 0) R_DH = path[i].R * path[i - 1].R.transpose() * R_DH;
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(p_DH[axis]), kWorkspace_m[axis] / 2 + 1e-12) << i;
    EXPECT_LE(rotationVector(R_DH).norm(), kWorkspace.turn_rad) << i;
    if (segment == segments.index_points.size() || i != segments.index_points[segment] + 1) continue;
    p_DH = segments.X_DH_start[++segment].p;
    R_DH = segments.X_DH_start[segment].R;
  }
  EXPECT_EQ(segment, segments.index_points.size());
}

TEST(PathSegments, APathThatFitsIsOneSegmentAroundTheMiddle) {
  Scene scene = farPin();
  scene.steps[0].X_WP_start = Pose::translation({0.3, 0, 50e-3});
  const PathSegments segments = splitPath(scene, scene.steps[0], kWorkspace);
  EXPECT_TRUE(segments.index_points.empty());
  ASSERT_EQ(segments.way_points.size(), 1u);
  ASSERT_EQ(segments.X_DH_start.size(), 1u);
  EXPECT_NEAR(segments.X_DH_start[0].p.x(), 0.15, 1e-12);
}

TEST(PathSegments, AStraightMetreTakesThreeSegmentsOfAtMostThirtySixCentimetres) {
  // A segment has 0.4 m minus 20 mm on each side. The later segments have the full length of 0.36 m, so the
  // first has the remaining 0.28 m.
  const Scene scene = farPin();
  const PathSegments segments = splitPath(scene, scene.steps[0], kWorkspace);
  ASSERT_EQ(segments.index_points, (std::vector<std::size_t>{0, 1}));
  EXPECT_NEAR(segments.way_points[0].p.x(), 0.72, 1e-9);
  EXPECT_NEAR(segments.way_points[1].p.x(), 0.36, 1e-9);
  EXPECT_EQ(segments.way_points[2].p, scene.steps[0].way_points[0].p);
  expectWithinWorkspace(scene, scene.steps[0], segments);
}

/// Pose at the target's position, rotated about z by this angle.
Pose turned(double turn_rad, double z_m) {
  return Pose(rotationFromVector(Vec3(0, 0, turn_rad)), Vec3(0, 0, z_m));
}

constexpr double kThird_rad = 2 * std::numbers::pi / 3;

/// A pin that is turned about z by two full turns, a third at a time, 1 mm above the plate, and set down.
Scene turningPin() {
  Scene scene = farPin();
  SceneStep& step = scene.steps[0];
  step.X_WP_start = turned(-6 * kThird_rad, 3e-3);
  step.way_points.clear();
  for (int third = 5; third >= 0; --third) step.way_points.push_back(turned(-third * kThird_rad, 3e-3));
  step.timeout_s = 120;
  return scene;
}

TEST(PathSegments, TwoFullTurnsAreSegmentsOfTwiceTheDevicesRangeLessItsMargin) {
  const Scene scene = turningPin();
  const PathSegments segments = splitPath(scene, scene.steps[0], kWorkspace);
  // A segment has 2 (0.78 - 0.1) = 1.36 rad; 4 pi are nine of these segments and a remainder.
  EXPECT_EQ(segments.index_points.size(), 9u);
  EXPECT_NEAR(rotationVector(segments.X_DH_start.back().R).z(), -0.68, 1e-9);
  expectWithinWorkspace(scene, scene.steps[0], segments);
}

TEST(PathSegments, ADeviceThatTurnsWithoutLimitNeedsNone) {
  const Scene scene = turningPin();
  EXPECT_TRUE(splitPath(scene, scene.steps[0], {kWorkspace_m, 0}).index_points.empty());
}

TEST(PathSegments, HalfATurnBetweenTwoPosesIsRefused) {
  Scene scene = turningPin();
  scene.steps[0].way_points = {turned(std::numbers::pi, 3e-3)};
  try {
    splitPath(scene, scene.steps[0], kWorkspace);
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("add a way point between them"), std::string::npos)
        << error.what();
  }
}

TEST(PathSegments, AnyPathStaysWithinTheWorkspaceAtAnyScale) {
  device::Random random(5);
  for (int i = 0; i < 200; ++i) {
    Scene scene = farPin();
    SceneStep& step = scene.steps[0];
    scene.device.scale = 0.5 + 2 * random.uniform();
    step.way_points.clear();
    for (int n = i % 5; n > 0; --n) step.way_points.push_back(Pose::translation(random.normal3()));
    step.X_WP_start = Pose{rotationFromVector(random.normal3()), 2 * random.normal3()};
    expectWithinWorkspace(scene, step, splitPath(scene, step, kWorkspace));
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
  // While the hand returns, the proxy does not move and the part hangs at rest on the coupling.
  int still = 0;
  for (std::size_t i = 1; i < result.trace.size(); ++i)
    still += result.trace[i].X_W_Proxy.p == result.trace[i - 1].X_W_Proxy.p &&
             result.trace[i].X_W_Proxy.p.x() > 0.1;
  EXPECT_GE(still,
            2 * 250);  // two returns of 1.5 s at 250 Hz take 750 steps; the part needs some to come to rest
}

TEST(Indexing, APartIsTurnedByTwoFullTurnsThroughADeviceThatTurnsByFortyFiveDegrees) {
  Scene scene = turningPin();
  const AssembleResult result = assemble(scene);
  ASSERT_EQ(result.steps.size(), 1u);
  const StepResult& step = result.steps[0];
  EXPECT_TRUE(step.completed) << step.failure_reason;
  EXPECT_EQ(step.index_count, 9);
  EXPECT_LE(result.energy.injected_J, 1e-3);
  double turned_rad = 0, farthest_rad = 0;
  for (std::size_t i = 1; i < result.trace.size(); ++i) {
    turned_rad += rotationVector(result.trace[i].X_WP.R * result.trace[i - 1].X_WP.R.transpose()).z();
    farthest_rad = std::max(farthest_rad, turned_rad);
  }
  EXPECT_NEAR(turned_rad, 4 * std::numbers::pi, 0.01);
  EXPECT_LT(farthest_rad, 4 * std::numbers::pi + 0.1);  // the part is never turned back
}

TEST(Indexing, ATurnBeyondTheDeviceIsRefusedWithoutIndexing) {
  Scene scene = turningPin();
  scene.device.has_indexing = false;
  try {
    assemble(scene);
    FAIL();
  } catch (const LoadError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("the device's handle turns by"), std::string::npos) << words;
    EXPECT_NE(words.find("indexing = true"), std::string::npos) << words;
  }
}

TEST(Indexing, AForceBeyondTheDeviceIsRefused) {
  Scene scene = farPin();
  scene.hand.press_N = 31;  // the dual arm's peak is 30 N
  try {
    assemble(scene);
    FAIL();
  } catch (const LoadError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("press_N is 31 N, but the device gives 30 N at most"), std::string::npos) << words;
  }
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
