// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "exact_fit.h"
#include "fit_record.h"

namespace vps {
namespace {

FitBody makeBody(const std::string& name, const Mesh& mesh) {
  VoxMapSettings voxels;
  voxels.voxel_m = 0.5e-3;
  PointShellSettings points;
  points.spacing_m = 1e-3;
  return {name, std::make_shared<VoxMap>(buildVoxMap(mesh, voxels)),
          std::make_shared<PointShell>(buildPointShell(mesh, points)), std::make_shared<MeshDistance>(mesh)};
}

class ExactFitOfBoxes : public ::testing::Test {
 protected:
  FitBody floor_ = makeBody("floor", makeBox(Vec3(0.02, 0.02, 0.01)));
  FitBody box_ = makeBody("box", makeBox(Vec3(0.01, 0.01, 0.01)));
  ExactFit fit_;
  void SetUp() override { fit_.mount(floor_, {}); }
};

// A pose's rounding is below 1e-17 m at 10 mm, distances are a few operations on such numbers.
constexpr double kRounding_m = 1e-15;

TEST_F(ExactFitOfBoxes, BoxAboveTheFloorIsFree) {
  EXPECT_EQ(fit_.deepest(box_, Pose::translation({0, 0, 10.02e-3})).depth_m, 0);
}

TEST_F(ExactFitOfBoxes, BoxThreeMicrometresDeepIsThreeMicrometresDeep) {
  const Penetration found = fit_.deepest(box_, Pose::translation({0, 0, 10e-3 - 3e-6}));
  EXPECT_NEAR(found.depth_m, 3e-6, kRounding_m);
  EXPECT_EQ(found.against, 0u);
}

TEST_F(ExactFitOfBoxes, CornerThatDipsInIsFoundAtTheCorner) {
  // Turned by a about y, the lowest edge is 5 mm (cos a + sin a) below the centre.
  const double a = 0.1, reach_m = 5e-3 * (std::cos(a) + std::sin(a));
  const Pose X_WP(rotationFromVector({0, a, 0}), Vec3(0, 0, 5e-3 + reach_m - 2e-6));
  EXPECT_NEAR(fit_.deepest(box_, X_WP).depth_m, 2e-6, kRounding_m);
}

TEST_F(ExactFitOfBoxes, FloorsOwnEdgeInsideTheMovingPartIsFoundToo) {
  // The box hangs over the floor's edge, tilted so that the floor's edge enters its flat underside.
  const double a = 0.3, deep_m = 4e-6;
  const Mat3 R = rotationFromVector({0, a, 0});
  // The middle of the underside lies deep_m beyond the edge x = 10 mm, z = 5 mm along the face's normal.
  const Vec3 outward = R * Vec3(0, 0, -1);
  const Pose X_WP(R, Vec3(10e-3, 0, 5e-3) + outward * deep_m - R * Vec3(0, 0, -5e-3));
  EXPECT_NEAR(fit_.deepest(box_, X_WP).depth_m, deep_m, kRounding_m);
}

TEST_F(ExactFitOfBoxes, JudgeFindsTheDeepestPoseEvenBetweenStrides) {
  std::vector<FitSample> samples;
  for (int i = 0; i < 1000; ++i) {
    const double depth_m = i == 501 ? 5e-6 : 1e-6;
    samples.push_back({i * 1e-3, Pose::translation({0, 0, 10e-3 - depth_m}), depth_m});
  }
  const FitVerdict verdict = judge(fit_, box_, samples, 10);
  EXPECT_NEAR(verdict.worst.depth_m, 5e-6, kRounding_m);
  EXPECT_DOUBLE_EQ(verdict.time_s, 0.501);
}

}  // namespace
}  // namespace vps
