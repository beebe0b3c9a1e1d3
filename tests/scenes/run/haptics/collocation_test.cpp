// SPDX-License-Identifier: BSD-3-Clause
// From touched calibration points to the position in the room at which a part in hand is drawn.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "support/random_draw.h"
#include "vps_device/calibration.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/scene/display.h"

namespace vps::scenes {
namespace {

/// True pose of the device: 0.8 m to the right of the room's origin, rotated and slightly tilted.
Pose trueDevice() {
  return {rotationFromVector(Vec3(0.05, -0.1, 1.2)), Vec3(0.8, 0.3, 0.7)};
}

/// Twelve points of the device's workspace, touched with 0.2 mm of error along each axis (standard
/// deviation).
device::Placement calibrated() {
  std::mt19937 random(7);
  std::normal_distribution<double> draw;
  std::vector<device::TouchedPoint> points;
  for (int i = 0; i < 12; ++i) {
    const Vec3 p_D = 0.15 * test::drawnVector(draw, random);
    points.push_back({p_D, trueDevice() * p_D + 0.2e-3 * test::drawnVector(draw, random)});
  }
  return device::fitPlacement(points);
}

/// The scene stands at (1, 0.2, 0.9) m in the room, turned a quarter, five times as large.
Display wall(const device::Placement& found) {
  Display display;
  display.X_SW = Pose(rotationFromVector(Vec3(0, 0, M_PI / 2)), Vec3(1, 0.2, 0.9));
  display.scale = 5;
  display.X_SD = found.X_SD;
  return display;
}

Scene block() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({20e-3, 20e-3, 2e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"block", makeBox({6e-3, 6e-3, 6e-3}), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 4e-3});
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 30e-3});
  scene.gravity_W = Vec3::Zero();
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  scene.device.kind = "mouse";
  return scene;
}

/// The mouse's handle needs 1.5 s from its start to the first place, half a metre away.
constexpr double kFirst_s = 3;

/// A hand that moves to these places and stays for a second at each.
std::vector<Vec3> drawnPlaces(const Display& display, const std::vector<Vec3>& p_D) {
  Scene scene = block();
  display.placeDevice(scene.device);
  std::atomic<bool> stop = false;
  AssembleOptions options;
  options.is_real_time = true;
  options.stop = &stop;
  options.wish = std::make_shared<device::HandleWish>();
  options.wish->write(Pose::translation(p_D[0]));
  std::vector<Vec3> drawn_S(p_D.size(), Vec3::Zero());
  std::size_t now = 0;
  SnapshotTap tap;
  tap.give = [&](Snapshot&& shot) {
    tap.is_wanted = true;
    if (shot.has_hand && now < drawn_S.size())
      drawn_S[now] = display.X_SW * Vec3(display.scale * shot.bodies[1].X_WP.p);
  };
  tap.is_wanted = true;
  options.tap = &tap;
  options.after_step = [&](double time_s) {
    now = time_s < kFirst_s ? 0 : 1 + static_cast<std::size_t>(time_s - kFirst_s);
    if (now < p_D.size()) options.wish->write(Pose::translation(p_D[now]));
    stop = now >= p_D.size();
  };
  assemble(scene, options);
  return drawn_S;
}

TEST(Collocation, ThePartInHandIsDrawnWhereTheHandIsToTheResidual) {
  const device::Placement found = calibrated();
  ASSERT_EQ(found.status, Status::Ok);
  ASSERT_GT(found.rms_m, 0.1e-3) << "there is a residual";
  const Display display = wall(found);
  // Places around the scene, in the device's frame.
  const Pose X_DS = trueDevice().inverse();
  std::vector<Vec3> p_D;
  for (const Vec3& p_S : {Vec3(1, 0.2, 1.1), Vec3(1.05, 0.2, 1.15), Vec3(0.95, 0.25, 1.08)})
    p_D.push_back(X_DS * p_S);
  const std::vector<Vec3> drawn_S = drawnPlaces(display, p_D);
  for (std::size_t i = 0; i < p_D.size(); ++i) {
    const Vec3 hand_S = trueDevice() * p_D[i];
    // Tolerance: twice the greatest residual, since these points lie outside the touched ones, plus 0.1 mm
    // for the error that coupling and mouse still have after a second.
    EXPECT_LT((drawn_S[i] - hand_S).norm(), 2 * found.greatest_m + 0.1e-3) << i;
  }
}

TEST(Collocation, WithoutAPlaceNothingChanges) {
  DeviceSettings device;
  device.scale = 3;
  Display display;
  display.scale = 7;
  display.placeDevice(device);
  EXPECT_EQ(device.scale, 3);
  EXPECT_FALSE(device.placement);
}

}  // namespace
}  // namespace vps::scenes
