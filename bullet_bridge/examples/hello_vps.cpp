// SPDX-License-Identifier: BSD-3-Clause
// One VPS part in an ordinary Bullet world: a ring drops over a peg. Stock Bullet would close its hole.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>
#include <vps_bullet/shape.h>

#include <cstdio>

int main() {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, vps::bullet::toBt(-9.81)));
  vps::bullet::install(
      dispatcher);  // from here on, VPS shapes collide: with each other and with Bullet's own

  // Of steel, with a hole of 10.1 mm; any closed mesh will do.
  const auto ring = vps::buildPartModel("ring", vps::makeTube(0.010, 0.00505, 0.005, 128));

  // Mass, inertia and centre of mass follow from the mesh; Bullet wants its bodies' origins there.
  const auto frame = vps::bullet::makeBodyFrame(ring->solid->mass(), ring->material.density_kg_m3);
  vps::bullet::Shape ring_shape(vps::bullet::makeModels(*ring), frame.X_PB.inverse());
  btRigidBody body(vps::bullet::toBt(frame.mass_kg), nullptr, &ring_shape,
                   vps::bullet::toBt(frame.inertia_kg_m2));
  body.setWorldTransform(vps::bullet::toBt(vps::Pose::translation({0, 0, 0.045}) * frame.X_PB));

  btCylinderShapeZ peg_shape(
      btVector3(vps::bullet::toBt(0.005), vps::bullet::toBt(0.005), vps::bullet::toBt(0.02)));
  btStaticPlaneShape ground_shape(btVector3(0, 0, 1), 0);  // plain Bullet, as is the peg of 10 mm on it
  btRigidBody peg(0, nullptr, &peg_shape), ground(0, nullptr, &ground_shape);
  peg.setWorldTransform(vps::bullet::toBt(vps::Pose::translation({0, 0, 0.02})));
  for (btRigidBody* b : {&body, &peg, &ground}) world.addRigidBody(b);
  vps::bullet::tuneWorld(world);  // parts of millimetres and grams rest still; returns what it changed
  for (int i = 0; i < 1000; ++i) world.stepSimulation(vps::bullet::toBt(1e-3), 0);
  std::printf("the ring lies at %.4f mm: half its height\n", 1e3 * body.getWorldTransform().getOrigin().z());
  for (btRigidBody* b : {&body, &peg, &ground}) world.removeRigidBody(b);
  vps::bullet::uninstall(dispatcher);
}
