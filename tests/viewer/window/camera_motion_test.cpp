// SPDX-License-Identifier: BSD-3-Clause
#include "view/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

constexpr PictureSize kMoved = {800, 600};
constexpr double kRounding = 1e-9;  // rounding error of a few dozen operations on lengths of about 1 m

Camera someCamera() {
  Camera camera;
  camera.eye_W = Vec3(1, -2, 1.5);
  camera.target_W = Vec3(0.1, 0.2, 0);
  return camera;
}

TEST(CameraMotionTest, ARayGoesThroughThePixelItIsMadeFrom) {
  const Camera camera = someCamera();
  const Ray ray = rayThrough(camera, {123.5, 456.25}, kMoved);
  EXPECT_NEAR(ray.d_W.norm(), 1, kRounding);
  const auto [x, y] = camera.project(ray.p_W + 0.7 * ray.d_W, kMoved.width, kMoved.height);
  EXPECT_NEAR(x, 123.5, 1e-6);
  EXPECT_NEAR(y, 456.25, 1e-6);
}

TEST(CameraMotionTest, AnOrbitKeepsTheDistanceAndADragOverHalfTheHeightTurnsByAQuarter) {
  Camera camera;
  camera.eye_W = Vec3(0, -2, 0);
  orbit(camera, {300, 0}, kMoved);
  EXPECT_NEAR((camera.eye_W - Vec3(-2, 0, 0)).norm(), 0, kRounding) << camera.eye_W.transpose();
  orbit(camera, {77, -31}, kMoved);
  EXPECT_NEAR((camera.eye_W - camera.target_W).norm(), 2, kRounding);
}

TEST(CameraMotionTest, ADragDownLooksFromFurtherAboveAndStopsShortOfThePole) {
  Camera camera;
  camera.eye_W = Vec3(0, -2, 0);
  orbit(camera, {0, 100}, kMoved);
  EXPECT_NEAR(camera.eye_W.z(), 2 * std::sin(std::numbers::pi / 6), kRounding);
  orbit(camera, {0, 10000}, kMoved);
  EXPECT_GT(camera.eye_W.z(), 1.99);
  EXPECT_LT(camera.eye_W.y(), 0) << "the camera has passed the pole";
  orbit(camera, {0, -20000}, kMoved);
  EXPECT_LT(camera.eye_W.z(), -1.99);
  EXPECT_LT(camera.eye_W.y(), 0) << "the camera has passed the pole";
}

TEST(CameraMotionTest, PanningMovesWhatIsAtTheTargetsDepthWithTheCursor) {
  Camera camera = someCamera();
  const Vec3 seen_W = camera.target_W;
  const auto before = camera.project(seen_W, kMoved.width, kMoved.height);
  pan(camera, {40, -25}, kMoved);
  const auto after = camera.project(seen_W, kMoved.width, kMoved.height);
  EXPECT_NEAR(after[0] - before[0], 40, 1e-6);
  EXPECT_NEAR(after[1] - before[1], -25, 1e-6);
}

TEST(CameraMotionTest, ZoomingKeepsWhatIsUnderTheCursorAndStopsAtItsLimits) {
  Camera camera = someCamera();
  const PixelPlace at = {200, 150};
  const double distance_m = (camera.eye_W - camera.target_W).norm();
  const Ray ray = rayThrough(camera, at, kMoved);
  const Vec3 ahead = (camera.target_W - camera.eye_W).normalized();
  const Vec3 seen_W = ray.p_W + ray.d_W * distance_m / ray.d_W.dot(ahead);
  zoom(camera, 2, at, kMoved, 1e-3, 100);
  EXPECT_NEAR((camera.eye_W - camera.target_W).norm(), distance_m / 2, kRounding);
  const auto [x, y] = camera.project(seen_W, kMoved.width, kMoved.height);
  EXPECT_NEAR(x, at[0], 1e-6);
  EXPECT_NEAR(y, at[1], 1e-6);
  zoom(camera, 1e9, at, kMoved, 0.5, 100);
  EXPECT_NEAR((camera.eye_W - camera.target_W).norm(), 0.5, kRounding);
  const Camera as_it_was = camera;
  zoom(camera, std::nan(""), at, kMoved, 0.5, 100);
  zoom(camera, -1, at, kMoved, 0.5, 100);
  EXPECT_EQ(camera, as_it_was);
}

TEST(CameraMotionTest, EveryStandardViewShowsTheWholeBoxFromItsSide) {
  const Box box{Vec3(-1, -2, 0), Vec3(2, 1, 1)};
  for (const StandardView& view : standardViews()) {
    const Camera camera = cameraFor(view, box, kMoved);
    EXPECT_NEAR((camera.eye_W - camera.target_W).normalized().dot(view.direction_W.normalized()), 1,
                kRounding);
    for (int i = 0; i < 8; ++i) {
      const Vec3 p((i & 1) ? box.max.x() : box.min.x(), (i & 2) ? box.max.y() : box.min.y(),
                   (i & 4) ? box.max.z() : box.min.z());
      const auto [x, y] = camera.project(p, kMoved.width, kMoved.height);
      EXPECT_TRUE(x > 0 && x < kMoved.width && y > 0 && y < kMoved.height) << view.name;
    }
  }
}

TEST(CameraMotionTest, FittingKeepsTheDirection) {
  const Camera camera = fitted(someCamera(), {Vec3(-1, -1, -1), Vec3(1, 1, 1)}, kMoved);
  const Vec3 was = (someCamera().eye_W - someCamera().target_W).normalized();
  EXPECT_NEAR((camera.eye_W - camera.target_W).normalized().dot(was), 1, kRounding);
  EXPECT_NEAR(camera.target_W.norm(), 0, kRounding);
}

TEST(CameraMotionTest, AWindowOfNoSizeGivesFiniteCameras) {
  constexpr PictureSize kNone = {0, 0};
  Camera camera = cameraFor(standardViews()[0], {Vec3(-1, -1, -1), Vec3(1, 1, 1)}, kNone);
  orbit(camera, {3, 4}, kNone);
  pan(camera, {3, 4}, kNone);
  zoom(camera, 1.1, {0, 0}, kNone, 0.1, 100);
  EXPECT_TRUE(camera.eye_W.allFinite() && camera.target_W.allFinite());
}

}  // namespace
}  // namespace vps::viewer
