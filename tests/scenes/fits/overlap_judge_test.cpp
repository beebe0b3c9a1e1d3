// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "judge/overlap_judge.h"
#include "judge/overlap_record.h"

namespace vps::scenes {
namespace {

JudgedBody makeBody(const std::string& name, const Mesh& mesh) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5e-3;
  PointShellSettings points;
  points.spacing_m = 1e-3;
  return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
}

class OverlapJudgeOfBoxes : public ::testing::Test {
 protected:
  JudgedBody floor_ = makeBody("floor", makeBox(Vec3(0.02, 0.02, 0.01)));
  JudgedBody box_ = makeBody("box", makeBox(Vec3(0.01, 0.01, 0.01)));
  OverlapJudge judge_;
  void SetUp() override { judge_.mount(floor_, {}); }
};

// A pose's rounding is below 1e-17 m at 10 mm, distances are a few operations on such numbers.
constexpr double kRounding_m = 1e-15;

TEST_F(OverlapJudgeOfBoxes, BoxAboveTheFloorIsFree) {
  EXPECT_EQ(judge_.deepest(box_, Pose::translation({0, 0, 10.02e-3})).depth_m, 0);
}

TEST_F(OverlapJudgeOfBoxes, BoxThreeMicrometresDeepIsThreeMicrometresDeep) {
  const Penetration found = judge_.deepest(box_, Pose::translation({0, 0, 10e-3 - 3e-6}));
  EXPECT_NEAR(found.depth_m, 3e-6, kRounding_m);
  EXPECT_EQ(found.against, 0u);
}

TEST_F(OverlapJudgeOfBoxes, ACornerThatDipsInIsFound) {
  // If the cube is turned by a about y, its lowest edge is 5 mm (cos a + sin a) below the centre.
  const double a = 0.1, reach_m = 5e-3 * (std::cos(a) + std::sin(a));
  const Pose X_WP(rotationFromVector({0, a, 0}), Vec3(0, 0, 5e-3 + reach_m - 2e-6));
  EXPECT_NEAR(judge_.deepest(box_, X_WP).depth_m, 2e-6, kRounding_m);
}

TEST_F(OverlapJudgeOfBoxes, FloorsOwnEdgeInsideTheMovingPartIsFoundToo) {
  // The box hangs over the floor's edge, tilted so that the floor's edge enters its flat underside.
  const double a = 0.3, deep_m = 4e-6;
  const Mat3 R = rotationFromVector({0, a, 0});
  // The middle of the underside lies deep_m beyond the edge x = 10 mm, z = 5 mm along the face's normal.
  const Vec3 outward = R * Vec3(0, 0, -1);
  const Pose X_WP(R, Vec3(10e-3, 0, 5e-3) + outward * deep_m - R * Vec3(0, 0, -5e-3));
  EXPECT_NEAR(judge_.deepest(box_, X_WP).depth_m, deep_m, kRounding_m);
}

TEST_F(OverlapJudgeOfBoxes, VoxmapsRankAPoseWithTheFloorsEdgeInAFaceAboveAFreeOne) {
  const Mat3 R = rotationFromVector({0, 0.3, 0});
  const auto at = [&](double deep_m) {
    return judge_.fieldDepth_m(box_, Pose(R, Vec3(10e-3, 0, 5e-3) + R * Vec3(0, 0, 5e-3 - deep_m)));
  };
  EXPECT_EQ(at(-1e-3), 0);
  // Only the floor's points on its edge are inside; the box's points are not.
  EXPECT_NEAR(at(50e-6), 50e-6, 5e-6);
  EXPECT_NEAR(at(20e-6), 20e-6, 5e-6);
}

TEST_F(OverlapJudgeOfBoxes, ThePenetrationOfAPartInsideAnotherIsThatOfItsDeepestPoint) {
  const JudgedBody block = makeBody("block", makeBox(Vec3::Constant(30e-3)));
  OverlapJudge judge;
  judge.mount(block, {});
  // The middle of each face of the 6 mm cube is 12 mm below the nearest face of the 30 mm block.
  const JudgedBody cube = makeBody("cube", makeBox(Vec3::Constant(6e-3)));
  EXPECT_NEAR(judge.deepest(cube, {}).depth_m, 12e-3, kRounding_m);
}

TEST(OverlapJudge, CrossingRidgesThatTouchBetweenProbesAreFound) {
  // Two square bars, each turned by 45 degrees about its length, laid crosswise ridge on ridge and lowered by
  // d. Each ridge dips d below the other's: where they cross, a point d deep along the bisector is d / sqrt 2
  // from both faces.
  const double side_m = 10e-3, half_diagonal_m = side_m / std::sqrt(2.0), d_m = 8e-6;
  const JudgedBody lower = makeBody("lower", makeBox(Vec3(40e-3, side_m, side_m)));
  const JudgedBody upper = makeBody("upper", makeBox(Vec3(side_m, 40e-3, side_m)));
  OverlapJudge judge;
  judge.mount(lower, Pose(rotationFromVector({M_PI / 4, 0, 0}), Vec3::Zero()));
  // The offsets are no multiples of the shell's spacing, so that no point is at the crossing.
  const Pose X_WU(rotationFromVector({0, M_PI / 4, 0}), Vec3(0.37e-3, 0.21e-3, 2 * half_diagonal_m - d_m));
  EXPECT_NEAR(judge.deepest(upper, X_WU).depth_m, d_m / std::sqrt(2.0),
              OverlapJudge::kCertain_m + kRounding_m);
}

TEST_F(OverlapJudgeOfBoxes, TheDeepestPoseIsFoundEvenBetweenStrides) {
  std::vector<OverlapSample> samples;
  for (int i = 0; i < 1000; ++i) {
    const double depth_m = i == 501 ? 5e-6 : 1e-6;
    // The sideways motion keeps consecutive poses apart, so that none is skipped.
    samples.push_back({i * 1e-3, Pose::translation({i * 1e-6, 0, 10e-3 - depth_m}), depth_m});
  }
  const OverlapVerdict verdict = judgeSamples(judge_, box_, samples, 10);
  EXPECT_NEAR(verdict.worst.depth_m, 5e-6, kRounding_m);
  EXPECT_DOUBLE_EQ(verdict.time_s, 0.501);
}

}  // namespace
}  // namespace vps::scenes
