// SPDX-License-Identifier: BSD-3-Clause
#include "view/picking.h"

#include <gtest/gtest.h>

#include "view/camera_motion.h"

namespace vps::viewer {
namespace {

constexpr PictureSize kSize = {800, 600};
constexpr double kRounding = 1e-12;  // rounding error of a few dozen operations on lengths of about 1 m

/// Two boxes of 0.1 m, one 0.3 m above the other, seen from above.
class PickingTest : public testing::Test {
 protected:
  PickingTest() {
    snapshot_.bodies = {{0, Pose::translation(Vec3::Zero()), scenes::BodyRole::Mounted},
                        {1, Pose::translation(Vec3(0, 0, 0.3)), scenes::BodyRole::InHand}};
  }
  Mesh box_ = makeBox(Vec3(0.1, 0.1, 0.1));
  RenderScene scene_ = {{&box_}, {&box_}};
  scenes::Snapshot snapshot_;
  DrawOptions options_;
  Ray down_ = {Vec3(0.01, 0.02, 1), -Vec3::UnitZ()};
};

TEST_F(PickingTest, TheNearestPartIsPickedAtItsSurface) {
  const auto found = pick(scene_, snapshot_, options_, down_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->part, 1U);
  EXPECT_NEAR((found->p_W - Vec3(0.01, 0.02, 0.35)).norm(), 0, kRounding);
  EXPECT_NEAR(found->distance_m, 0.65, kRounding);
}

TEST_F(PickingTest, WhatIsNotShownIsNotPicked) {
  snapshot_.bodies[1].role = scenes::BodyRole::Waiting;
  ASSERT_TRUE(pick(scene_, snapshot_, options_, down_));
  EXPECT_EQ(pick(scene_, snapshot_, options_, down_)->part, 0U);
  options_.show_waiting = true;
  EXPECT_EQ(pick(scene_, snapshot_, options_, down_)->part, 1U);
  EXPECT_FALSE(pick(scene_, snapshot_, options_, {Vec3(0.2, 0, 1), -Vec3::UnitZ()}));
  EXPECT_FALSE(pick(scene_, snapshot_, options_, {Vec3(0, 0, 1), Vec3::UnitZ()})) << "behind the eye";
}

TEST_F(PickingTest, ASectionUncoversThePartBehindItsPlaneAndItsCutFaceIsPicked) {
  options_.cut = CutPlane{Vec3(0, 0, 0.02), Vec3::UnitZ(), true};
  const auto found = pick(scene_, snapshot_, options_, down_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->part, 0U);
  EXPECT_NEAR(found->p_W.z(), 0.02, kRounding);
  options_.cut->cuts_hand = false;
  EXPECT_EQ(pick(scene_, snapshot_, options_, down_)->part, 1U) << "the part in hand stays whole";
}

TEST(SectionDragTest, ADragMovesThePlaneByWhatItMovesOnTheScreen) {
  Camera camera;
  camera.eye_W = Vec3(0, -2, 0);
  CutPlane cut;
  cut.n_W = Vec3::UnitZ();
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  const auto before = camera.project(cut.p_W, kSize.width, kSize.height);
  dragSection(cut, camera, {13, -50}, kSize, box);
  const auto after = camera.project(cut.p_W, kSize.width, kSize.height);
  EXPECT_NEAR(after[1] - before[1], -50, 1e-9);
  EXPECT_NEAR(cut.p_W.x(), 0, kRounding);
  dragSection(cut, camera, {0, -1e6}, kSize, box);
  EXPECT_NEAR(cut.p_W.z(), 1, kRounding) << "the plane stays within the box";
}

TEST(SectionDragTest, APlaneThatFacesTheEyeMovesAwayWhenDraggedUp) {
  Camera camera;
  camera.eye_W = Vec3(0, -2, 0);
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  CutPlane cut = sectionFacing(camera, box);
  EXPECT_NEAR((cut.n_W + Vec3::UnitY()).norm(), 0, kRounding);
  dragSection(cut, camera, {0, -20}, kSize, box);
  EXPECT_GT(cut.p_W.y(), 0.01);
}

TEST(SectionDragTest, ATiltOverHalfTheHeightIsAQuarterTurn) {
  Camera camera;
  camera.eye_W = Vec3(0, -2, 0);
  CutPlane cut;
  cut.n_W = -Vec3::UnitY();
  tiltSection(cut, camera, {300, 0}, kSize);
  EXPECT_NEAR((cut.n_W - Vec3::UnitX()).norm(), 0, 1e-9) << cut.n_W.transpose();
}

}  // namespace
}  // namespace vps::viewer
