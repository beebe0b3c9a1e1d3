// SPDX-License-Identifier: BSD-3-Clause
// Distances at the poses of a snapshot, against formulas.
#include "vps_scenes/run/part_gaps.h"

#include <gtest/gtest.h>

namespace vps::scenes {
namespace {

constexpr double kRounding_m = 1e-15;  // of coordinates below 1 m

/// A plate of 100 x 100 x 20 mm about the origin, and two cubes of 20 mm.
Scene plateAndCubes() {
  Scene scene;
  for (const Vec3& size_m : {Vec3(0.1, 0.1, 0.02), Vec3(0.02, 0.02, 0.02), Vec3(0.02, 0.02, 0.02)}) {
    ScenePart part;
    part.part.mesh = makeBox(size_m);
    scene.parts.push_back(part);
  }
  return scene;
}

Snapshot with(const Pose& first, const Pose& second) {
  Snapshot shot;
  shot.bodies = {{0, {}, BodyRole::Mounted}, {1, first, BodyRole::InHand}, {2, second, BodyRole::Mounted}};
  return shot;
}

TEST(PartGaps, ArePlacedWhereTheSnapshotHasTheParts) {
  const PartGaps gaps(plateAndCubes());
  // The first cube is 30 um above the plate and 1 mm from the other cube.
  const Snapshot shot =
      with(Pose::translation(Vec3(0, 0, 0.02 + 30e-6)), Pose::translation(Vec3(0.021, 0, 0.025)));
  const std::vector<PartGap> found = gaps.of(1, shot, 2e-3);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].other, 0u);
  EXPECT_NEAR(found[0].distance_m, 30e-6, kRounding_m);
  EXPECT_NEAR(found[0].p_W.z(), 0.01 + 15e-6, kRounding_m);
  EXPECT_EQ(found[1].other, 2u);
  EXPECT_NEAR(found[1].distance_m, 1e-3, kRounding_m);
  EXPECT_EQ(gaps.of(1, shot, 1e-4).size(), 1u) << "nearer than a tenth of a millimetre";
}

TEST(PartGaps, OfACubeOnItsCornerIsThatOfTheCorner) {
  const PartGaps gaps(plateAndCubes());
  const Mat3 R = Eigen::Quaterniond::FromTwoVectors(Vec3(-1, -1, -1), Vec3(0, 0, -1)).toRotationMatrix();
  const double half_diagonal_m = 0.01 * std::sqrt(3.0);
  const Snapshot shot =
      with(Pose(R, Vec3(0.013, -0.007, 0.01 + half_diagonal_m + 12e-6)), Pose::translation(Vec3(1, 0, 0)));
  const std::vector<PartGap> found = gaps.of(1, shot, 1e-3);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].distance_m, 12e-6, kRounding_m);
}

TEST(PartGaps, AreZeroWherePartsOverlapAndLeaveOutPartsThatWait) {
  const PartGaps gaps(plateAndCubes());
  Snapshot shot = with(Pose::translation(Vec3(0, 0, 0.015)), Pose::translation(Vec3(0.015, 0, 0.04)));
  std::vector<PartGap> found = gaps.of(1, shot, 1e-3);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].distance_m, 0);
  shot.bodies[0].role = BodyRole::Waiting;
  EXPECT_TRUE(gaps.of(1, shot, 1e-3).empty());
  EXPECT_TRUE(gaps.of(7, shot, 1e-3).empty()) << "no such part";
}

TEST(PartGaps, TellBetweenWhichPartsAContactIs) {
  const PartGaps gaps(plateAndCubes());
  // The first cube is 2 um deep in the plate and 3 um deep in the second cube at its side.
  Snapshot shot =
      with(Pose::translation(Vec3(0, 0, 0.02 - 2e-6)), Pose::translation(Vec3(0.02 - 3e-6, 0, 0.025)));
  shot.contacts = {{Vec3(0.004, 0.002, 0.01), Vec3::UnitZ(), 2e-6, 1.5, Vec3::Zero()},
                   {Vec3(-0.004, 0.002, 0.01), Vec3::UnitZ(), 2e-6, 0.5, Vec3::Zero()},
                   {Vec3(0.01, 0.003, 0.0295), Vec3::UnitX(), 3e-6, 0.25, Vec3::Zero()},
                   {Vec3(0.3, 0.3, 0.3), Vec3::UnitX(), 3e-6, 9, Vec3::Zero()}};  // far from every part
  const std::vector<PartTouch> touches = gaps.touches(shot);
  ASSERT_EQ(touches.size(), 2u);
  EXPECT_EQ(touches[0].a, 0u);
  EXPECT_EQ(touches[0].b, 1u);
  EXPECT_EQ(touches[0].force_N, 2.0);
  EXPECT_EQ(touches[1].a, 1u);
  EXPECT_EQ(touches[1].b, 2u);
  EXPECT_EQ(touches[1].force_N, 0.25);
}

}  // namespace
}  // namespace vps::scenes
