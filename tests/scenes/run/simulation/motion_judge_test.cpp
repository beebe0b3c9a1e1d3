// SPDX-License-Identifier: BSD-3-Clause
// Overlaps between the poses at the ends of steps: the family C_judge has more of them.
#include "judge/motion_judge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "judge/overlap_record.h"
#include "scenes/scene_part.h"
#include "simulation/body_overlaps.h"
#include "support/units.h"
#include "vps_scenes/run/simulate.h"
#include "world/step_rows.h"

namespace vps::scenes {
namespace {

MovingBody movingBody(const Mesh& mesh, bool is_fixed) {
  return {bounds(mesh), Vec3::Zero(), is_fixed,
          [mesh] { return std::make_shared<const ExactBody>(std::make_shared<const Solid>(mesh)); }};
}

/// A fixed body at the origin and another one.
MotionJudge judgeOf(const Mesh& fixed, const Mesh& moving, const Pose& X_0) {
  return MotionJudge({movingBody(fixed, true), movingBody(moving, false)}, {Pose(), X_0}, 0);
}

const Mesh kPlate = makeBox({100 * kMm, 100 * kMm, 2 * kMm});
const Mesh kBall = makeSphere(5 * kMm, 3);

TEST(MotionJudge, APassageThroughAPlateIsAsDeepAsHalfThePlateAndHasItsTime) {
  for (const double speed_m_s : {20.0, 50.0, 500.0, 5000.0}) {
    const double from_m = 0.25 * speed_m_s * 1e-3 + 7 * kMm;
    MotionJudge judge = judgeOf(kPlate, kBall, Pose::translation({1 * kMm, 2 * kMm, from_m}));
    const double to_m = from_m - speed_m_s * 1e-3;
    ASSERT_LT(to_m, -6 * kMm);  // apart again
    judge.addStep(1e-3, {Pose(), Pose::translation({1 * kMm, 2 * kMm, to_m})}, 0);
    judge.search();
    const DeepestOverlap& deepest = judge.deepest();
    EXPECT_NEAR(deepest.depth_m, 1 * kMm, MotionJudge::toleranceOf(1 * kMm)) << speed_m_s;
    EXPECT_GE(judge.bound_m(), 1 * kMm);
    const double z_m = from_m - speed_m_s * deepest.time_s;
    EXPECT_LT(std::abs(z_m), 6 * kMm) << speed_m_s;  // at a time when the body is in the plate
    EXPECT_LT(judge.measured(), 60U) << speed_m_s;
  }
}

// A ball in a bore lies inside the bore's convex hull, although their triangles do not intersect during the
// motion.
TEST(MotionJudge, WhatFliesAlongABoreIsExcludedByItsFacets) {
  constexpr int kSides = 48;
  const Mesh bore = makeTube(10 * kMm, 5 * kMm / std::cos(M_PI / kSides) + 10 * kUm, 40 * kMm, kSides);
  for (const double speed_m_s : {5.0, 50.0, 500.0, 5000.0})
    for (const double turn_rad : {0.0, 0.02}) {
      const double from_m = 0.5 * speed_m_s * 1e-3 + 30 * kMm;
      MotionJudge judge = judgeOf(bore, kBall, Pose::translation({0, 0, from_m}));
      const Pose end(rotationFromVector({0, 0, turn_rad}), Vec3(0, 0, from_m - speed_m_s * 1e-3 - 60 * kMm));
      judge.addStep(1e-3, {Pose(), end}, 100e3);
      judge.search();
      EXPECT_EQ(judge.deepest().depth_m, 0) << speed_m_s;
      EXPECT_EQ(judge.bound_m(), MotionJudge::toleranceOf(0)) << speed_m_s << " m/s, " << turn_rad;
      EXPECT_LT(judge.measured(), 30U) << speed_m_s << " m/s, " << turn_rad;
    }
}

TEST(MotionJudge, APinAcrossABoreIsSeenFromTheBall) {
  Mesh bore = makeTube(10 * kMm, 5.1 * kMm, 40 * kMm, 48);
  const Mesh pin = transformed(makeCylinder(1 * kMm, 14 * kMm, 24),
                               Pose(rotationFromVector({M_PI / 2, 0, 0}), Vec3(0, 0, 3 * kMm)));
  const auto first = static_cast<std::uint32_t>(bore.vertices.size());
  bore.vertices.insert(bore.vertices.end(), pin.vertices.begin(), pin.vertices.end());
  for (const auto& t : pin.triangles) bore.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  MotionJudge judge = judgeOf(bore, kBall, Pose::translation({0, 0, 300 * kMm}));
  judge.addStep(1e-3, {Pose(), Pose::translation({0, 0, -300 * kMm})}, 100e3);
  judge.search();
  EXPECT_GT(judge.deepest().depth_m, 4 * kMm);  // the pin in the middle of the ball
}

TEST(MotionJudge, WhatSlidesAndRollsOnAPlateIsExcludedWithoutMeasures) {
  const double r_m = 5 * kMm;
  MotionJudge judge = judgeOf(kPlate, kBall, Pose::translation({-20 * kMm, 0, r_m + 1 * kMm + 0.1 * kUm}));
  for (int step = 1; step <= 40; ++step) {
    const double x_m = step * 1 * kMm;  // 1 m/s
    judge.addStep(step * 1e-3,
                  {Pose(), Pose(rotationFromVector({0, x_m / r_m, 0}),
                                Vec3(-20 * kMm + x_m, 0, r_m + 1 * kMm + 0.1 * kUm))},
                  0);
  }
  judge.search();
  EXPECT_EQ(judge.deepest().depth_m, 0);
  EXPECT_LE(judge.bound_m(), MotionJudge::toleranceOf(0));
  EXPECT_LE(judge.measured(), 2U);
}

TEST(MotionJudge, WhatRestsIsMeasuredOnce) {
  const Pose X = Pose::translation({0, 0, 6 * kMm - 20 * kUm});
  MotionJudge judge = judgeOf(kPlate, kBall, X);
  for (int step = 1; step <= 1000; ++step) {
    Pose now = X;
    now.p.x() += 1e-10 * (step % 2);
    judge.addStep(step * 1e-3, {Pose(), now}, 0);
  }
  judge.search();
  // Below the lowest vertex or edge of the sphere's mesh.
  EXPECT_NEAR(judge.deepest().depth_m, 20 * kUm, 0.5 * kUm);
  EXPECT_LE(judge.measured(), 3U);
}

// In a bore no direction separates the hulls.
TEST(MotionJudge, WithoutCreditTheBoundTellsWhatMayHaveBeenMissed) {
  const Mesh tube = makeTube(10 * kMm, 5.02 * kMm, 60 * kMm, 64);
  MotionJudge judge = judgeOf(tube, kBall, Pose::translation({0, 0, -20 * kMm}));
  for (int step = 1; step <= 20; ++step)
    judge.addStep(step * 1e-3, {Pose(), Pose::translation({0, 0, (2 * step - 20) * kMm})}, -1e9);
  judge.search();
  EXPECT_EQ(judge.deepest().depth_m, 0);
  EXPECT_GT(judge.bound_m(), 0.5 * kMm);
}

TEST(MotionJudge, ADepthThatIsAllowedDoesNotCountUntilItIsForbiddenAgain) {
  const Pose X = Pose::translation({0, 0, 6 * kMm - 100 * kUm});
  MotionJudge judge = judgeOf(kPlate, kBall, X);
  judge.allow({0, 1}, 150 * kUm);
  judge.addStep(1e-3, {Pose(), X * Pose::translation({0, 0, -30 * kUm})}, 0);
  judge.search();
  EXPECT_EQ(judge.deepest().depth_m, 0);
  judge.forbid({0, 1});
  judge.addStep(2e-3, {Pose(), X}, 0);
  judge.search();
  EXPECT_NEAR(judge.deepest().depth_m, 130 * kUm, 5 * kUm);
}

// A box on the floor turns about its vertical axis by 57 degrees in a step. During the motion its corners are
// farther out than at both end poses, so it hits a post at its side.
TEST(MotionJudge, ATurnWithinAStepIsFollowedAlongItsArcs) {
  const Mesh post = makeBox({2 * kMm, 2 * kMm, 20 * kMm}), bar = makeBox({40 * kMm, 4 * kMm, 4 * kMm});
  const double reach_m = std::hypot(20.0, 2.0) * kMm;
  const Vec3 p_W(0, -reach_m, 0);
  for (const auto& [beside_m, is_hit] : {std::pair{-0.5 * kMm, true}, std::pair{1.5 * kMm, false}}) {
    const auto at = [&](double turn_rad) {
      return Pose(rotationFromVector({0, 0, M_PI / 2 + turn_rad}), Vec3(p_W - Vec3(0, beside_m, 0)));
    };
    MotionJudge judge = judgeOf(post, bar, at(-0.5));
    judge.addStep(1e-3, {Pose(), at(0.5)}, 0);
    judge.search();
    EXPECT_EQ(judge.deepest().depth_m > 0.1 * kMm, is_hit) << judge.deepest().depth_m;
  }
}

TEST(MotionJudge, AnOpenSheetIsSeenWhenItIsPassed) {
  Mesh sheet;
  sheet.vertices = {
      {-50 * kMm, -50 * kMm, 0}, {50 * kMm, -50 * kMm, 0}, {50 * kMm, 50 * kMm, 0}, {-50 * kMm, 50 * kMm, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  MotionJudge judge = judgeOf(sheet, kBall, Pose::translation({3 * kMm, 7 * kMm, 20 * kMm}));
  judge.addStep(1e-3, {Pose(), Pose::translation({3 * kMm, 7 * kMm, -30 * kMm})}, 0);
  judge.search();
  // The sheet passes through the middle of the ball.
  EXPECT_NEAR(judge.deepest().depth_m, 5 * kMm, 0.5 * kMm);
}

TEST(BodyOverlaps, APassageBetweenTwoStepsCountsAsAnOverlap) {
  Scene scene;
  scene.file = scene.name = "passage";
  scene.parts = {scenePart("plate", kPlate, Vec3::Zero(), true),
                 scenePart("ball", kBall, {0, 0, 20 * kMm}, false)};
  BodyOverlaps overlaps(scene);
  overlaps.judgeStart();
  overlaps.move(1, Pose::translation({0, 0, -30 * kMm}));
  overlaps.endStep(1e-3, 0);
  overlaps.judge(1e-3);
  const JudgedOverlap judged = overlaps.result();
  EXPECT_FALSE(judged.isWithinLimit());
  EXPECT_EQ(judged.deepest.a, "ball");
  EXPECT_EQ(judged.deepest.b, "plate");
  EXPECT_NEAR(judged.deepest.depth_m, 1 * kMm, MotionJudge::toleranceOf(1 * kMm));
  EXPECT_NEAR(judged.deepest.time_s, 0.4e-3, 0.12e-3);
  EXPECT_EQ(overlaps.deepest().deepest.depth_m, judged.deepest.depth_m);
}

TEST(OverlapRecord, APassageBetweenTwoSamplesOfAStepIsFound) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5 * kMm;
  PointShellSettings points;
  points.spacing_m = 1 * kMm;
  const auto body = [&](const char* name, const Mesh& mesh) {
    return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
  };
  OverlapJudge judge;
  judge.mount(body("plate", kPlate), {});
  const std::vector<OverlapSample> samples = {{0, Pose::translation({0, 0, 20 * kMm}), 0},
                                              {1e-3, Pose::translation({0, 0, -30 * kMm}), 0}};
  const OverlapVerdict verdict = judgeSamples(judge, body("ball", kBall), samples, 200);
  EXPECT_NEAR(verdict.worst.depth_m, 1 * kMm, MotionJudge::toleranceOf(1 * kMm));
  EXPECT_EQ(verdict.worst.against, 0U);
  EXPECT_LT(verdict.unsearched_m, 1.2 * kMm);  // the depth is the same along the whole path through the plate
}

/// A path in two legs, over the edge of a plate and down along its side, with a rest at the end.
std::vector<OverlapSample> aroundAnEdge(int rest) {
  StepRows rows(1000);
  rows.beginStep(bounds(kBall));
  const Vec3 corner(56 * kMm, 0, 7 * kMm), from(4.16 * kMm, 0, 7 * kMm), to(56 * kMm, 0, -44.84 * kMm);
  constexpr int kLeg = 576;  // steps of 0.09 mm; the corner is between two samples
  for (int i = 0; i < 2 * kLeg + rest; ++i) {
    const double share = std::min(1.0, static_cast<double>(i % kLeg) / kLeg);
    const Vec3 p = i < kLeg       ? Vec3(from + share * (corner - from))
                   : i < 2 * kLeg ? Vec3(corner + share * (to - corner))
                                  : to;
    rows.add({}, {i * 1e-3, Pose::translation(p), 0});
  }
  return rows.takeSamples();
}

// The straight line between two samples that are 128 steps apart leads through the plate, but the path does
// not.
TEST(OverlapRecord, AThinnedWayAroundAnEdgeIsFree) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5 * kMm;
  PointShellSettings points;
  points.spacing_m = 1 * kMm;
  const auto body = [&](const char* name, const Mesh& mesh) {
    return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
  };
  OverlapJudge judge;
  judge.mount(body("plate", kPlate), {});
  const std::vector<OverlapSample> samples = aroundAnEdge(63'000);
  ASSERT_LE(samples.size(), 1000U);
  std::vector<OverlapSample> as_one_way = samples;
  for (OverlapSample& sample : as_one_way) sample.follows = true;
  const JudgedBody ball = body("ball", kBall);
  EXPECT_GT(judgeSamples(judge, ball, as_one_way, 200).worst.depth_m, 0.1 * kMm);
  const OverlapVerdict verdict = judgeSamples(judge, ball, samples, 200);
  EXPECT_EQ(verdict.worst.depth_m, 0);
  EXPECT_EQ(verdict.unsearched_m, 0);
}

TEST(OverlapRecord, APassageThatIsNotSearchedIsTold) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5 * kMm;
  PointShellSettings points;
  points.spacing_m = 1 * kMm;
  const auto body = [&](const char* name, const Mesh& mesh) {
    return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
  };
  OverlapJudge judge;
  judge.mount(body("plate", kPlate), {});
  const std::vector<OverlapSample> samples = {{0, Pose::translation({0, 0, 20 * kMm}), 0},
                                              {1e-3, Pose::translation({0, 0, -30 * kMm}), 0}};
  const std::atomic<bool> stop = true;
  EXPECT_GT(judgeSamples(judge, body("ball", kBall), samples, 200, &stop).unsearched_m, 0.9 * kMm);
}

// Facets of 5.6 degrees are no sharp edges, and the shell's points lie on their faces and not at vertices.
TEST(OverlapJudge, AVertexOfAFinelyMeshedBallHasItsDepth) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5 * kMm;
  PointShellSettings points;
  points.spacing_m = 1 * kMm;
  OverlapJudge judge;
  judge.mount(makeJudgedBody(buildPartModel("plate", kPlate, voxels, points)), {});
  const JudgedBody ball = makeJudgedBody(buildPartModel("ball", makeSphere(5 * kMm, 4), voxels, points));
  for (int i = 0; i < 20; ++i) {
    const Mat3 R = rotationFromVector({0.1 * i, 0.23 * i, -0.07 * i});
    double lowest_m = 0;
    for (const Vec3& v : ball.model->solid->mesh().vertices) lowest_m = std::min(lowest_m, (R * v).z());
    const Pose X(R, Vec3(0.1 * kMm, 0.2 * kMm, 1 * kMm - lowest_m - 2 * kUm));
    EXPECT_NEAR(judge.deepest(ball, X).depth_m, 2 * kUm, 1e-12) << i;
  }
}

// Contact is soft, so that the body sinks in by much more than the depth that the solver sees at the start of
// a step.
TEST(Simulate, ReportsTheExactDepthAndBesideItThatOfTheContacts) {
  Scene scene;
  scene.file = scene.name = "sinks";
  scene.parts = {scenePart("plate", kPlate, Vec3::Zero(), true),
                 scenePart("block", makeBox({8 * kMm, 6 * kMm, 4 * kMm}), {0, 0, 3.1 * kMm}, false)};
  scene.fidelity.contact_method = ContactMethod::Penalty;
  for (ScenePart& part : scene.parts) part.part.material.stiffness_N_per_m3 = 1e8;
  double lowest_m = 1;
  SimulateOptions options;
  options.trace = [&](double, const std::vector<BodyState>& bodies, double) {
    lowest_m = std::min(lowest_m, bodies.front().X_WP.p.z());
  };
  const SimulateResult result = simulate(scene, 0.03, options);
  const double depth_m = 3 * kMm - lowest_m;  // the body falls flat
  ASSERT_GT(depth_m, 5 * kUm);
  EXPECT_NEAR(result.max_penetration_m, depth_m, MotionJudge::toleranceOf(depth_m));
  EXPECT_EQ(result.exact.deepest.depth_m, result.max_penetration_m);
  EXPECT_NEAR(result.exact.bound_m,
              result.max_penetration_m + MotionJudge::toleranceOf(result.max_penetration_m), 1e-12);
  EXPECT_GT(result.contact_depth_m, 0);
  EXPECT_FALSE(result.overlap.has_value());

  options.is_real_time = true;
  const SimulateResult by_clock = simulate(scene, 0.005, options);
  options.is_real_time = false;
  const SimulateResult by_steps = simulate(scene, 0.005, options);
  EXPECT_EQ(by_clock.max_penetration_m, by_steps.max_penetration_m);
  EXPECT_EQ(by_clock.exact.bound_m, by_steps.exact.bound_m);
  EXPECT_GT(by_clock.max_penetration_m, 0);
}

}  // namespace
}  // namespace vps::scenes
