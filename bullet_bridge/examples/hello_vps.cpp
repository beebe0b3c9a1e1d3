// SPDX-License-Identifier: BSD-3-Clause
// One part with VPS contact in an ordinary Bullet world: a ring drops over a peg. Bullet's convex shapes
// would close its hole.
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
  vps::bullet::install(dispatcher);  // now every bullet::Shape collides

  vps::Part ring;  // of steel, with a hole of 10.1 mm; any closed mesh can be used
  ring.mesh = vps::makeTube(0.010, 0.00505, 0.005, 128);
  ring.map = std::make_shared<const vps::VoxMap>(vps::buildVoxMap(ring.mesh, {}));
  ring.shell = std::make_shared<const vps::PointShell>(vps::buildPointShell(ring.mesh, {}));

  // Mass, inertia and centre of mass follow from the mesh; Bullet requires the body's origin at the centre of
  // mass.
  const auto frame = vps::bullet::makeBodyFrame(vps::massProperties(ring.mesh), ring.material.density_kg_m3);
  vps::bullet::Shape ring_shape(vps::bullet::makeModels(ring), frame.X_PB.inverse());
  btRigidBody body(vps::bullet::toBt(frame.mass_kg), nullptr, &ring_shape,
                   vps::bullet::toBt(frame.inertia_kg_m2));
  body.setWorldTransform(vps::bullet::toBt(vps::Pose::translation({0, 0, 0.045}) * frame.X_PB));

  btCylinderShapeZ peg_shape(
      btVector3(vps::bullet::toBt(0.005), vps::bullet::toBt(0.005), vps::bullet::toBt(0.02)));
  btStaticPlaneShape ground_shape(btVector3(0, 0, 1),
                                  0);  // Bullet's own shapes: the ground, and on it a peg of 10 mm
  btRigidBody peg(0, nullptr, &peg_shape), ground(0, nullptr, &ground_shape);
  peg.setWorldTransform(vps::bullet::toBt(vps::Pose::translation({0, 0, 0.02})));
  for (btRigidBody* b : {&body, &peg, &ground}) world.addRigidBody(b);
  vps::bullet::tuneWorld(world);  // parameters for parts of millimetres and grams; returns what it changed
  for (int i = 0; i < 1000; ++i) world.stepSimulation(vps::bullet::toBt(1e-3), 0);
  std::printf("the ring lies at %.4f mm, half its height\n", 1e3 * body.getWorldTransform().getOrigin().z());
  for (btRigidBody* b : {&body, &peg, &ground}) world.removeRigidBody(b);
  vps::bullet::uninstall(dispatcher);
}
