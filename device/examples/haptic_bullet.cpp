// SPDX-License-Identifier: BSD-3-Clause
// Haptics in an ordinary Bullet world: a hand presses a block on the floor and feels it. The example runs in
// simulated time; with hardware only loop.tick() changes: it runs in a thread of its own.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/coupling.h>
#include <vps_device/dual_arm/simulated_dual_arm.h>
#include <vps_device/gains.h>
#include <vps_device/loop.h>

#include <cmath>
#include <cstdio>

int main() {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, vps::bullet::toBt(-9.81)));
  btStaticPlaneShape floor_shape(btVector3(0, 0, 1), 0);
  btBoxShape block_shape(
      btVector3(vps::bullet::toBt(0.02), vps::bullet::toBt(0.02), vps::bullet::toBt(0.02)));
  btVector3 inertia;
  block_shape.calculateLocalInertia(vps::bullet::toBt(0.1), inertia);
  btRigidBody floor(0, nullptr, &floor_shape), block(vps::bullet::toBt(0.1), nullptr, &block_shape, inertia);
  block.setWorldTransform(vps::bullet::toBt(vps::Pose::translation({0, 0, 0.03})));  // 10 mm above the floor
  block.setActivationState(DISABLE_DEACTIVATION);
  world.addRigidBody(&floor);
  world.addRigidBody(&block);

  vps::device::SimulatedDualArm device;  // or any other vps::Device
  vps::device::LoopSettings settings;    // 1 kHz
  settings.gains = vps::device::deriveGains(device.limits(), {});
  vps::device::CouplingPort port;  // exchanges state between the haptic and the physics side
  vps::device::HapticLoop loop(device, port, settings);
  vps::bullet::CouplingConstraint coupling(block, vps::Pose{}, settings.gains);
  world.addConstraint(&coupling, true);
  loop.grasp(vps::bullet::fromBt(block.getWorldTransform()));  // no force jumps, wherever the handle is

  vps::device::HandForce hand;  // a spring of 500 N/m, whose far end moves down by 20 mm in a second
  hand.k_N_per_m = 500 * vps::Mat3::Identity();
  hand.b_Ns_per_m = 20 * vps::Mat3::Identity();
  hand.k_Nm_per_rad = 3 * vps::Mat3::Identity();
  hand.b_Nms_per_rad = 0.1 * vps::Mat3::Identity();
  for (int i = 0; i < 2000; ++i) {
    loop.tick();
    hand.X_eq.p.z() = -0.02 * std::fmin(1, i / 1000.0);
    device.step(1e-3, hand);
    coupling.setTarget(port.haptic.read().proxy);
    world.stepSimulation(vps::bullet::toBt(1e-3), 0);
    vps::CouplingState part = coupling.partState();
    part.is_coupled = true;
    port.physics.write({part, 0, {}, {}});
  }
  const double felt_N = loop.last().F_hand_W.f.z(), pressed_N = -device.lastHandWrench().f.z();
  std::printf("the hand presses with %.2f N and feels %.2f N\n", pressed_N, felt_N);
  world.removeConstraint(&coupling);
  for (btRigidBody* b : {&floor, &block}) world.removeRigidBody(b);
  return std::abs(felt_N - pressed_N) < 0.5 && felt_N > 3 ? 0 : 1;  // device friction holds at most 0.14 N
}
