// SPDX-License-Identifier: BSD-3-Clause
#include "view/table_room.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vps::viewer {
namespace {

Box boxOf(const Vec3& min, const Vec3& max) {
  Box box;
  box.add(min);
  box.add(max);
  return box;
}

TEST(TableRoom, TheSceneStandsBeforeAndBelowTheHeadSixtyCentimetresWide) {
  const Box box_W = boxOf(Vec3(0.1, 0.2, 0.3), Vec3(0.3, 0.24, 0.35));  // the largest size is 0.2 m
  const TableRoom room = onTable(box_W);
  EXPECT_NEAR(room.scale, 3, 1e-12);
  EXPECT_TRUE(room.toRoom(Vec3(0.2, 0.22, 0.3)).isApprox(Vec3(0, -0.45, -0.6), 1e-12))
      << "middle of the floor";
  // Right stays right, up stays up, and parts that lie behind in the front view are farther away.
  EXPECT_TRUE(room.toRoom(Vec3(0.3, 0.22, 0.3)).isApprox(Vec3(0.3, -0.45, -0.6), 1e-12));
  EXPECT_TRUE(room.toRoom(Vec3(0.2, 0.22, 0.35)).isApprox(Vec3(0, -0.3, -0.6), 1e-12));
  EXPECT_TRUE(room.toRoom(Vec3(0.2, 0.24, 0.3)).isApprox(Vec3(0, -0.45, -0.66), 1e-12));
  EXPECT_TRUE(room.toScene(room.toRoom(Vec3(1, 2, 3))).isApprox(Vec3(1, 2, 3), 1e-12));
  EXPECT_NEAR(onTable(boxOf(Vec3::Zero(), Vec3(0.01, 0.01, 0.2))).scale, 2, 1e-12)
      << "a tower is scaled to a height of 0.4 m";
  EXPECT_NEAR(room.toScene(Pose()).R.determinant(), 1, 1e-12);
}

TEST(TableRoom, ASceneWithoutSizeIsShownAtItsOwn) {
  EXPECT_EQ(onTable(Box()).scale, 1);
  EXPECT_TRUE(std::isfinite(onTable(boxOf(Vec3::Zero(), Vec3::Zero())).scale));
}

TEST(TableRoom, APointIsInTheEyesPictureWhereItsAnglesAre) {
  const Box box_W = boxOf(Vec3(-0.05, -0.02, 0), Vec3(0.05, 0.02, 0.03));
  const TableRoom room = onTable(box_W);
  HeadsetEye eye;
  eye.X_RE = Pose(rotationFromVector(Vec3(-0.6, 0.1, 0.05)), Vec3(0.032, 0.01, 0.02));
  eye.left = std::tan(-0.4);
  eye.right = std::tan(0.5);
  eye.down = std::tan(-0.45);
  eye.up = std::tan(0.35);
  constexpr int kWidth = 1800, kHeight = 2000;
  const Camera camera = cameraOf(room, eye, box_W);
  for (const Vec3& p_W : {Vec3(-0.05, -0.02, 0), Vec3(0.05, 0.02, 0.03), Vec3(0.01, 0, 0.02)}) {
    const Vec3 p_E = eye.X_RE.inverse() * room.toRoom(p_W);  // the eye looks along -z (OpenXR 1.0, 2.17)
    const double x = kWidth * (p_E.x() / -p_E.z() - eye.left) / (eye.right - eye.left);
    const double y = kHeight * (eye.up - p_E.y() / -p_E.z()) / (eye.up - eye.down);
    const auto seen = camera.project(p_W, kWidth, kHeight);
    EXPECT_NEAR(seen[0], x, 1e-6);
    EXPECT_NEAR(seen[1], y, 1e-6);
  }
}

}  // namespace
}  // namespace vps::viewer
