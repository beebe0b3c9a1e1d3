// SPDX-License-Identifier: BSD-3-Clause
// A motor turns the first of three gears; the others turn because their teeth touch.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>
#include <vps_bullet/solver.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "support/gear.h"  // makes involute gears; your own meshes come from CAD

using vps::bullet::toBt;

namespace {

constexpr double kPi = std::numbers::pi, kModule_m = 2e-3, kSpeed_rad_s = 2 * kPi;
constexpr int kTeeth[3] = {20, 30, 15};

/// On a fixed axle along z at `x_m`.
struct Gear {
  vps::bullet::Body body;
  std::unique_ptr<btHingeConstraint> axle;

  Gear(int teeth, double x_m, double turned_rad) {
    vps::test::GearShape gear;
    gear.module_m = kModule_m;
    gear.teeth = teeth;
    gear.backlash_m = 0.05e-3;
    vps::bullet::BodySettings settings;
    settings.material.friction = 0.1;
    settings.X_WP = vps::Pose(vps::rotationFromVector({0, 0, turned_rad}), {x_m, 0, 0});
    body = vps::bullet::makeBody(vps::test::makeSpurGear(gear), settings);
    const vps::Pose X_BP = body.frame.X_PB.inverse();  // the axle in the body's frame
    axle = std::make_unique<btHingeConstraint>(*body.rigid, toBt(X_BP.p), toBt(vps::Vec3(X_BP.R.col(2))));
  }
};

}  // namespace

int main() {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  vps::bullet::Solver solver;  // joints and contacts in one solve
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, 0));
  vps::bullet::install(dispatcher);

  // A tooth of the first points at the second, which is turned by half a tooth so that a space meets it. It
  // has a space on its far side too, and the third, of an odd number of teeth, is turned so that a tooth
  // meets that.
  const double x1_m = kModule_m * (kTeeth[0] + kTeeth[1]) / 2,
               x2_m = x1_m + kModule_m * (kTeeth[1] + kTeeth[2]) / 2;
  Gear gears[3] = {{kTeeth[0], 0, 0}, {kTeeth[1], x1_m, kPi / kTeeth[1]}, {kTeeth[2], x2_m, kPi / kTeeth[2]}};
  for (Gear& gear : gears) {
    world.addRigidBody(gear.body.rigid.get());
    world.addConstraint(gear.axle.get(), true);
  }
  vps::bullet::tuneWorld(world);
  for (Gear& gear : gears) gear.body.rigid->setActivationState(DISABLE_DEACTIVATION);
  gears[0].axle->enableAngularMotor(true, toBt(kSpeed_rad_s), toBt(1e-3));  // greatest impulse a step: 1 Nm

  double turned_rad[3] = {0, 0, 0};
  for (int i = 0; i < 300; ++i) {
    world.stepSimulation(toBt(1e-3), 0);
    for (int k = 0; k < 3; ++k) turned_rad[k] += 1e-3 * gears[k].body.rigid->getAngularVelocity().z();
  }
  std::printf("turned by %.4f, %.4f and %.4f revolutions in 0.3 s\n", turned_rad[0] / (2 * kPi),
              turned_rad[1] / (2 * kPi), turned_rad[2] / (2 * kPi));
  for (Gear& gear : gears) {
    world.removeConstraint(gear.axle.get());
    world.removeRigidBody(gear.body.rigid.get());
  }
  vps::bullet::uninstall(dispatcher);
  // They have turned by as many teeth, but for their backlash, 0.1 mm of a tooth pitch of 6.28 mm at each
  // mesh.
  const auto teeth = [&](int k) { return std::abs(turned_rad[k]) / (2 * kPi) * kTeeth[k]; };
  return teeth(0) > 5.9 && std::abs(teeth(1) - teeth(0)) < 0.04 && std::abs(teeth(2) - teeth(0)) < 0.06 ? 0
                                                                                                        : 1;
}
