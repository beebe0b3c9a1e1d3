// SPDX-License-Identifier: BSD-3-Clause
// `simulate` with its overlap judged by exact distance, and with parts that are not ordinary solids.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/scene_part.h"
#include "simulation/body_overlaps.h"
#include "support/units.h"
#include "vps/errors.h"
#include "vps_scenes/run/simulate.h"

namespace vps::scenes {
namespace {

Mesh blockMesh() {
  return makeBox({10 * kMm, 8 * kMm, 6 * kMm});
}

/// A block above a plate whose top is z = 0.
Scene blockOnPlate(double gap_m, double plate_m = 5 * kMm) {
  Scene scene;
  scene.file = scene.name = "block";
  scene.parts = {scenePart("plate", makeBox({40 * kMm, 40 * kMm, plate_m}), {0, 0, -plate_m / 2}, true),
                 scenePart("block", blockMesh(), {0, 0, 3 * kMm + gap_m}, false)};
  return scene;
}

struct Watched {
  SimulateResult result;
  double fastest_m_s = 0;  ///< of the first body's origin
};

Watched judged(Scene scene, double seconds, int judge_every = 1) {
  Watched watched;
  SimulateOptions options;
  options.judge_every = judge_every;
  options.trace = [&](double, const std::vector<BodyState>& bodies, double) {
    watched.fastest_m_s = std::max(watched.fastest_m_s, bodies.front().V_WP_W.v.norm());
  };
  watched.result = simulate(scene, seconds, options);
  return watched;
}

TEST(SimulateJudge, ABlockThatFallsOnAPlateIsWithinTheLimit) {
  const JudgedOverlap judged = *vps::scenes::judged(blockOnPlate(1 * kMm), 0.1).result.overlap;
  EXPECT_DOUBLE_EQ(judged.limit_m, 10 * kUm);
  EXPECT_EQ(judged.poses_judged, 101U);  // the start and each step
  EXPECT_TRUE(judged.isWithinLimit()) << judged.deepest.depth_m;
  EXPECT_TRUE(judged.at_start.empty());
}

// A block falls on a block on the plate that has a thousandth of its mass. If the solver has not converged,
// the heavy block presses the light one through the plate.
TEST(SimulateJudge, AHeavyBlockDoesNotPressALightOneThroughThePlate) {
  const Mesh cube = makeBox({10 * kMm, 10 * kMm, 10 * kMm});
  Scene scene = blockOnPlate(0);
  scene.parts[1] = scenePart("light", cube, {0, 0, 5 * kMm}, false);
  scene.parts.push_back(scenePart("heavy", cube, {0.5 * kMm, 0.3 * kMm, 15.2 * kMm}, false));
  scene.parts.back().X_WP.R = rotationFromVector({0, 0, 0.35});
  scene.parts.back().part.material.density_kg_m3 *= 1000;
  scene.parts.back().V_WP_W.v = {0, 0, -0.8};
  const JudgedOverlap judged = *vps::scenes::judged(scene, 0.1).result.overlap;
  EXPECT_TRUE(judged.isWithinLimit()) << judged.deepest.depth_m;
}

TEST(SimulateJudge, JudgesEveryFewStepsAndTheLast) {
  EXPECT_EQ(judged(blockOnPlate(1 * kMm), 0.025, 10).result.overlap->poses_judged, 4U);  // 0, 10, 20, 25
  Scene scene = blockOnPlate(1 * kMm);
  EXPECT_FALSE(simulate(scene, 0.01).overlap.has_value());
}

TEST(SimulateJudge, AClearanceInTheSceneLowersTheLimit) {
  Scene scene = blockOnPlate(1 * kMm);
  scene.steps.emplace_back().part = 1;
  scene.steps.back().clearance_m = 20 * kUm;
  EXPECT_DOUBLE_EQ(judged(scene, 0.002).result.overlap->limit_m, 5 * kUm);
}

TEST(BodyOverlaps, FindsTheDeepestPairWithItsPlaceAndTime) {
  const Scene scene = blockOnPlate(1 * kMm);
  BodyOverlaps overlaps(scene);
  overlaps.judgeStart();
  for (const double depth_m : {5 * kUm, 200 * kUm, 100 * kUm}) {
    overlaps.move(1, Pose::translation({0, 0, 3 * kMm - depth_m}));
    overlaps.judge(depth_m);  // any time
  }
  const JudgedOverlap judged = overlaps.result();
  EXPECT_FALSE(judged.isWithinLimit());
  EXPECT_NEAR(judged.deepest.depth_m, 200 * kUm, kOverlapCertain_m);
  EXPECT_EQ(judged.deepest.a + judged.deepest.b, "blockplate");
  EXPECT_EQ(judged.deepest.time_s, 200 * kUm);
  EXPECT_NEAR(judged.deepest.at_W.z(), -100 * kUm, 101 * kUm);
  EXPECT_EQ(judged.poses_judged, 4U);
  EXPECT_TRUE(judged.at_start.empty());
}

TEST(BodyOverlaps, APairThatStartsOverlappedCountsWhereItBecomesDeeperOrOverlapsAgain) {
  const Scene scene = blockOnPlate(-0.5 * kMm);
  const auto deepestAfter = [&](const std::vector<double>& depths_m) {
    BodyOverlaps overlaps(scene);
    overlaps.judgeStart();
    double time_s = 0;
    for (const double depth_m : depths_m) {
      overlaps.move(1, Pose::translation({0, 0, 3 * kMm - depth_m}));
      overlaps.judge(++time_s);
    }
    return overlaps.result();
  };
  const JudgedOverlap parted = deepestAfter({0.5 * kMm, 0.505 * kMm, 0.3 * kMm, 5 * kUm, 8 * kUm});
  EXPECT_TRUE(parted.isWithinLimit()) << parted.deepest.depth_m;
  ASSERT_EQ(parted.at_start.size(), 1U);
  EXPECT_NEAR(parted.at_start[0].start.depth_m, 0.5 * kMm, kOverlapCertain_m);
  EXPECT_EQ(parted.at_start[0].apart_s, 4.0);
  EXPECT_FALSE(deepestAfter({0.52 * kMm}).isWithinLimit());
  EXPECT_FALSE(deepestAfter({0.3 * kMm, 0, 20 * kUm}).isWithinLimit());
  EXPECT_EQ(parted.neverApart(), 0U);
  const JudgedOverlap stuck = deepestAfter({0.3 * kMm, 0.2 * kMm});
  EXPECT_FALSE(stuck.at_start[0].apart_s.has_value());
  EXPECT_NEAR(stuck.at_start[0].end_depth_m, 0.2 * kMm, kOverlapCertain_m);
  EXPECT_EQ(stuck.deepest.depth_m, 0);
  EXPECT_EQ(stuck.neverApart(), 1U);
  EXPECT_FALSE(stuck.isWithinLimit());
}

TEST(SimulateJudge, StartsWithTheVelocityOfTheScene) {
  Scene scene = blockOnPlate(50 * kMm);
  scene.gravity_W = Vec3::Zero();
  scene.parts[1].V_WP_W.v = Vec3(0.1, 0, 0.2);
  scene.parts[1].V_WP_W.w = Vec3(0, 0, 3);
  const BodyState end = simulate(scene, 0.1).bodies.front();
  EXPECT_NEAR((end.X_WP.p - (scene.parts[1].X_WP.p + 0.1 * Vec3(0.1, 0, 0.2))).norm(), 0, 1e-9);
  EXPECT_NEAR((rotationVector(end.X_WP.R) - Vec3(0, 0, 0.3)).norm(), 0, 1e-6);
}

// --- Bad input

TEST(SimulateJudge, BodiesThatStartOverlappedAreSaidAndSeparatedGently) {
  const Watched watched = judged(blockOnPlate(-0.5 * kMm), 0.2);
  const JudgedOverlap& judged = *watched.result.overlap;
  ASSERT_EQ(judged.at_start.size(), 1U);
  EXPECT_NEAR(judged.at_start[0].start.depth_m, 0.5 * kMm, 1 * kUm);
  ASSERT_TRUE(judged.at_start[0].apart_s.has_value());
  EXPECT_GT(*judged.at_start[0].apart_s, 0.5 * kMm / 0.06);
  // The overlap does not count as missed by contact.
  EXPECT_TRUE(judged.isWithinLimit()) << judged.deepest.depth_m;
  // The bridge separates at 0.05 m/s; gravity adds the speed of one step.
  EXPECT_LT(watched.fastest_m_s, 0.05 + 0.0099);
}

TEST(SimulateJudge, ASheetHoldsABlockAndIsRefusedAsABody) {
  Mesh sheet;
  sheet.vertices = {
      {-20 * kMm, -20 * kMm, 0}, {20 * kMm, -20 * kMm, 0}, {20 * kMm, 20 * kMm, 0}, {-20 * kMm, 20 * kMm, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  Scene scene = blockOnPlate(1 * kMm);
  scene.parts[0] = scenePart("sheet", sheet, Vec3::Zero(), true);
  const BodyState block = judged(scene, 0.2).result.bodies.front();
  EXPECT_NEAR(block.X_WP.p.z(), 3 * kMm, 10 * kUm);
  EXPECT_LT(block.V_WP_W.v.norm(), 1e-3);

  scene.parts[0].is_fixed = false;
  try {
    simulate(scene, 0.01);
    FAIL() << "a sheet has no mass";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("sheet"), std::string::npos) << error.what();
  }
}

TEST(SimulateJudge, PointsAreRefusedWithTheirName) {
  Mesh none, point;
  point.vertices = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  point.triangles = {{0, 1, 2}};
  for (const Mesh& mesh : {none, point})
    for (const bool is_fixed : {false, true}) {
      Scene scene = blockOnPlate(1 * kMm);
      scene.parts.push_back(scenePart("dust", mesh, Vec3(0, 0, 20 * kMm), is_fixed));
      try {
        simulate(scene, 0.01);
        FAIL() << "a point has no surface";
      } catch (const LoadError& error) {
        EXPECT_NE(std::string(error.what()).find("dust"), std::string::npos) << error.what();
      }
    }
}

TEST(SimulateJudge, APlateThinnerThanAVoxelHoldsABlock) {
  for (const double share : {0.4, 0.04}) {
    Scene scene = blockOnPlate(1 * kMm, share * 0.25 * kMm);
    ASSERT_EQ(scene.fidelity.voxel_m, 0.25 * kMm);
    const Watched watched = judged(scene, 0.2);
    // An overlap cannot be deeper than half the plate's thickness, so the pose is tested too.
    EXPECT_NEAR(watched.result.bodies.front().X_WP.p.z(), 3 * kMm, 10 * kUm) << share;
    EXPECT_TRUE(watched.result.overlap->isWithinLimit()) << watched.result.overlap->deepest.depth_m;
  }
}

TEST(SimulateJudge, APlateThinnerThanAVoxelFallsOnABlock) {
  Scene scene;
  scene.file = scene.name = "thin";
  scene.parts = {scenePart("block", blockMesh(), {0, 0, -3 * kMm}, true),
                 scenePart("plate", makeBox({30 * kMm, 30 * kMm, 0.1 * kMm}), {1 * kMm, 0, 2 * kMm}, false)};
  const Watched watched = judged(scene, 0.2);
  EXPECT_NEAR(watched.result.bodies.front().X_WP.p.z(), 0.05 * kMm, 10 * kUm);
  EXPECT_TRUE(watched.result.overlap->isWithinLimit()) << watched.result.overlap->deepest.depth_m;
}

}  // namespace
}  // namespace vps::scenes
