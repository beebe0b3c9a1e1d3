// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_drag.h"

#include <gtest/gtest.h>

namespace vps::viewer {
namespace {

TEST(HandMarkTest, SaysForceAndTorqueAndIsAtTheEndOfItsColoursAtTheMousesGreatestForce) {
  scenes::Snapshot shot;
  shot.F_hand_W.f = Vec3(3, 0, 4);
  shot.F_hand_W.tau = Vec3(0, 0.25, 0);
  EXPECT_EQ(handMark(shot).words, "5.0 N  0.25 N m");
  EXPECT_DOUBLE_EQ(handMark(shot).share, 0.5);
  shot.F_hand_W.tau = Vec3(0, 1, 0);
  EXPECT_DOUBLE_EQ(handMark(shot).share, 1);
}

TEST(HandMarkTest, IsBesideTheHandAndInStereoAtOnePlaceOfBothEyesPictures) {
  Camera camera;
  camera.eye_W = Vec3(0, 0, 1);
  camera.up_W = Vec3::UnitY();
  const PictureSize size = {800, 600};
  const auto placesIn = [&](StereoMode mode) { return handMarkPlaces(mode, Vec3::Zero(), camera, size); };
  ASSERT_EQ(placesIn(StereoMode::Mono).size(), 1u);
  EXPECT_NEAR(placesIn(StereoMode::Mono)[0][0], 400 + 16, 1e-9);
  EXPECT_NEAR(placesIn(StereoMode::Mono)[0][1], 300, 1e-9);
  const auto beside = placesIn(StereoMode::SideBySide), above = placesIn(StereoMode::TopBottom);
  ASSERT_EQ(beside.size(), 2u);
  EXPECT_EQ(beside[1][0] - beside[0][0], 400) << "no parallax: the screen's own depth";
  EXPECT_EQ(beside[1][1], beside[0][1]);
  ASSERT_EQ(above.size(), 2u);
  EXPECT_EQ(above[1][1] - above[0][1], 300);
  EXPECT_EQ(above[1][0], above[0][0]);
  EXPECT_EQ(placesIn(StereoMode::Anaglyph).size(), 1u);
  EXPECT_EQ(placesIn(StereoMode::Interleaved).size(), 1u);
}

}  // namespace
}  // namespace vps::viewer
