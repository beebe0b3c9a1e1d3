// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

constexpr PictureSize kDragged = {800, 600};

/// A part that the hand holds at its middle, 0.2 m in front of a camera that looks along +y.
scenes::Snapshot held(const Vec3& p_W) {
  scenes::Snapshot shot;
  shot.step = 0;
  shot.has_hand = true;
  shot.bodies = {{0, Pose::translation(p_W), scenes::BodyRole::InHand}};
  shot.X_W_Proxy = Pose::translation(p_W);
  return shot;
}
Camera camera() {
  Camera camera;
  camera.eye_W = Vec3(0, -0.2, 0);
  camera.target_W = Vec3::Zero();
  return camera;
}

TEST(HandDrag, TheGrabbedPointStaysUnderTheCursor) {
  const scenes::Snapshot shot = held(Vec3::Zero());
  for (const HandMotion motion : {HandMotion::Across, HandMotion::Depth}) {
    HandDrag drag(1);
    drag.watch(shot);
    const Vec3 p_W(0.01, -0.02, 0.015);
    drag.grab(p_W, shot);
    const auto before = camera().project(p_W, kDragged.width, kDragged.height);
    drag.drag(camera(), {70, -40}, kDragged, motion);
    const auto after = camera().project(drag.cursorPoint(), kDragged.width, kDragged.height);
    const bool is_across = motion == HandMotion::Across;
    EXPECT_NEAR(after[0], before[0] + (is_across ? 70 : 0), 1e-9);
    EXPECT_NEAR(after[1], before[1] + (is_across ? -40 : 0), 1e-9);
    // The handle moves by the same displacement as the grabbed point.
    EXPECT_LT((drag.wish()->read().p - (drag.cursorPoint() - p_W)).norm(), 1e-15);
    const double farther_m = (drag.cursorPoint() - camera().eye_W).norm() - (p_W - camera().eye_W).norm();
    EXPECT_TRUE(is_across || farther_m > 0);
  }
}

TEST(HandDrag, AHandleThatIsScaledMovesByLess) {
  const scenes::Snapshot shot = held(Vec3::Zero());
  HandDrag drag(4);
  drag.watch(shot);
  drag.grab(Vec3::Zero(), shot);
  drag.drag(camera(), {0, -300}, kDragged, HandMotion::Across);
  // The drag goes up by half the picture's height, at the depth of the point.
  EXPECT_NEAR(drag.wish()->read().p.z(), 0.2 * std::tan(0.25) / 4, 1e-15);
}

TEST(HandDrag, TurnsAboutTheScreensAxesAndTheLineOfSight) {
  const scenes::Snapshot shot = held(Vec3::Zero());
  const auto turned = [&](const PixelPlace& by, HandMotion motion) {
    HandDrag drag(1);
    drag.watch(shot);
    drag.grab(Vec3::Zero(), shot);
    drag.drag(camera(), by, kDragged, motion);
    EXPECT_EQ(drag.wish()->read().p.norm(), 0);
    return rotationVector(drag.wish()->read().R);
  };
  // The camera looks along +y, with +x to the right and +z up. A drag over the picture's height is half a
  // turn.
  const double quarter_rad = std::numbers::pi / 2;
  EXPECT_LT((turned({300, 0}, HandMotion::Turn) - Vec3(0, 0, quarter_rad)).norm(), 1e-12);
  EXPECT_LT((turned({0, 300}, HandMotion::Turn) - Vec3(quarter_rad, 0, 0)).norm(), 1e-12);
  EXPECT_LT((turned({300, 0}, HandMotion::Twist) - Vec3(0, quarter_rad, 0)).norm(), 1e-12)
      << "a drag to the right turns clockwise for the viewer, which is right-handed about the line of sight";
}

TEST(HandDrag, LettingGoBringsTheHandleToThePart) {
  scenes::Snapshot shot = held(Vec3::Zero());
  HandDrag drag(2);
  drag.watch(shot);
  drag.grab(Vec3::Zero(), shot);
  drag.drag(camera(), {0, 500}, kDragged, HandMotion::Across);
  drag.drag(camera(), {100, 0}, kDragged, HandMotion::Turn);
  // A wall stopped the part after 3 mm and a small rotation.
  const Vec3 turn_rad(0, 0, 0.1);
  shot.bodies[0].X_WP = Pose(rotationFromVector(turn_rad), Vec3(0, 0, -3e-3));
  shot.X_W_Proxy.p.z() = -5e-3;
  drag.letGo(shot);
  EXPECT_FALSE(drag.isGrabbed());
  EXPECT_LT((drag.wish()->read().p - Vec3(0, 0, -1.5e-3)).norm(), 1e-15);
  EXPECT_LT((rotationVector(drag.wish()->read().R) - turn_rad).norm(), 1e-12);
  const Pose before = drag.wish()->read();
  drag.drag(camera(), {50, 50}, kDragged, HandMotion::Across);
  EXPECT_EQ(drag.wish()->read().p, before.p) << "nothing is grabbed";
}

TEST(HandDrag, GrabsNothingWhereNoPartIsInHand) {
  scenes::Snapshot shot = held(Vec3::Zero());
  shot.bodies[0].role = scenes::BodyRole::Released;
  HandDrag drag(1);
  drag.watch(shot);
  drag.grab(Vec3::Zero(), shot);
  EXPECT_FALSE(drag.isGrabbed());
}

}  // namespace
}  // namespace vps::viewer
