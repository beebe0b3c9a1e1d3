// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/gear.h"
#include "vps_bullet/convert.h"

namespace vps::dynamics {

namespace {

constexpr double kModule_m = 2e-3, kBacklash_m = 0.05e-3;  // module and backlash of each gear
constexpr int kDriver = 20, kDriven = 30;
constexpr double kBrake_Nm = 1;

Mesh makeGear(int teeth) {
  test::GearShape gear;
  gear.module_m = kModule_m;
  gear.teeth = teeth;
  gear.width_m = teeth == kDriver ? 12e-3 : 10e-3;  // a pinion is wider, so that the ends need not be aligned
  gear.backlash_m = kBacklash_m;
  gear.other_radius_m = 8e-3;
  return test::makeSpurGear(gear);
}

// A hinge about z through the gear's centre, fixed to the world.
std::unique_ptr<btTypedConstraint> makeHinge(const Placed& gear) {
  const Pose X_BP = gear.part.frame.X_PB.inverse();
  return std::make_unique<btHingeConstraint>(*gear.body, bullet::toBt(X_BP.p),
                                             bullet::toBt(Vec3(X_BP.R.col(2))));
}

}  // namespace

GearPairResult runGears(const SceneSettings& settings) {
  static const PartMesh driver_part = makePart(makeGear(kDriver)), driven_part = makePart(makeGear(kDriven));
  constexpr double kPi = std::numbers::pi, kSpeed_rad_s = 2 * kPi, kRatio = double(kDriver) / kDriven;
  World world(settings);
  world.setGravity(Vec3::Zero());
  const double distance_m = kModule_m * (kDriver + kDriven) / 2;
  // Tooth 0 of the driver points at the axis of the driven gear. The driven gear is turned by half a tooth,
  // so that a gap between its teeth faces that tooth.
  const Placed driver = world.add(driver_part, Pose(), false, 0);
  const Placed driven = world.add(
      driven_part, Pose(rotationFromVector(Vec3(0, 0, kPi / kDriven)), Vec3(distance_m, 0, 0)), false, 0);
  for (const Placed& gear : {driver, driven}) world.addConstraint(makeHinge(gear));

  // A spring-damper turns the driver, so that its torque is known. Both gears start at full speed.
  constexpr double kSpring_Nm = 20, kDamper_Nms = 0.02;
  driver.body->setAngularVelocity(btVector3(0, 0, btScalar(kSpeed_rad_s)));
  driven.body->setAngularVelocity(btVector3(0, 0, btScalar(-kSpeed_rad_s * kRatio)));
  TurnCounter driver_turn(driver), driven_turn(driven);
  GearPairResult result;
  result.deepest_m = -1e300;
  const double turns = settings.is_short ? 0.5 : 10, settle_s = 0.3;
  const int steps =
      static_cast<int>(std::lround((turns / (kSpeed_rad_s / (2 * kPi)) + settle_s) / World::kStep_s));
  const int settle = static_cast<int>(std::lround(settle_s / World::kStep_s));
  double drive_Nm = 0, start_rad = 0, error_sum_rad[2] = {0, 0};
  int count[2] = {0, 0};
  for (int i = 0; i < steps; ++i) {
    const double t_s = i * World::kStep_s;
    const double lag_rad = kSpeed_rad_s * t_s - driver_turn.update();
    const double slow_rad_s = kSpeed_rad_s - driver.body->getAngularVelocity().z();
    const double torque_Nm = kSpring_Nm * lag_rad + kDamper_Nms * slow_rad_s;
    driver.body->applyTorque(btVector3(0, 0, btScalar(torque_Nm)));
    driven.body->applyTorque(
        btVector3(0, 0, btScalar(kBrake_Nm)));  // the driven gear turns in the opposite direction
    world.step();
    const double error_rad = driven_turn.update() + kRatio * driver_turn.update();
    if (i % 50 == 0)
      result.deepest_m =
          std::max(result.deepest_m, penetration_m(driver.part, driver.pose(), driven.part, driven.pose()));
    if (i < settle) continue;
    if (i == settle) start_rad = error_rad;
    drive_Nm += torque_Nm;
    result.ratio_error_rad = std::max(result.ratio_error_rad, std::abs(error_rad - start_rad));
    // Means over whole turns at the start and at the end.
    const int turn_steps = std::min(1000, (steps - settle) / 2);
    const int end = i < settle + turn_steps ? 0 : i >= steps - turn_steps ? 1 : -1;
    if (end >= 0) error_sum_rad[end] += error_rad, ++count[end];
  }
  result.turns = driver_turn.update() / (2 * kPi);
  result.ratio_drift_rad = std::abs(error_sum_rad[1] / count[1] - error_sum_rad[0] / count[0]);
  result.torque_share = kBrake_Nm * kRatio / (drive_Nm / (steps - settle));
  result.step_ms = 1e3 * world.times().mean_s();
  return result;
}

}  // namespace vps::dynamics
