// SPDX-License-Identifier: BSD-3-Clause
// The shortest program: a ring with a hole falls over a peg in an ordinary Bullet world. Bullet itself would
// collide with the convex hull of the ring, which has no hole.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>

#include <cmath>
#include <cstdio>

using vps::bullet::toBt;  // converts numbers, vectors and poses of vps into those of Bullet

int main() {
  // An ordinary Bullet world. Lengths are in metres, masses in kilograms, times in seconds.
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));

  // Registers VPS contact with the dispatcher. From now on parts collide with each other and with Bullet's
  // own shapes.
  vps::bullet::install(dispatcher);

  // Makes a rigid body from a closed triangle mesh: here a ring of 20 mm outer diameter, 10.1 mm inner
  // diameter and 5 mm height, in 128 sectors. Mass and inertia follow from the mesh; the usual material is
  // steel.
  vps::bullet::BodySettings settings;
  settings.X_WP = vps::Pose::translation({0, 0, 0.045});  // the ring starts above the peg
  const vps::bullet::Body ring = vps::bullet::makeBody(vps::makeTube(0.010, 0.00505, 0.005, 128), settings);
  world.addRigidBody(ring.rigid.get());

  // Two shapes of Bullet's own: a peg of 10 mm diameter and 40 mm height, which stands on the ground.
  btCylinderShapeZ peg_shape(btVector3(toBt(0.005), toBt(0.005), toBt(0.02)));
  btStaticPlaneShape ground_shape(btVector3(0, 0, 1), 0);
  btRigidBody peg(0, nullptr, &peg_shape), ground(0, nullptr, &ground_shape);
  peg.setWorldTransform(toBt(vps::Pose::translation({0, 0, 0.02})));
  world.addRigidBody(&peg);
  world.addRigidBody(&ground);

  // Sets Bullet's parameters for parts of millimetres and grams. Call it when all bodies are in the world.
  vps::bullet::tuneWorld(world);

  // One second in steps of one millisecond. X_WP() is the present pose of the ring's mesh.
  for (int i = 0; i < 1000; ++i) world.stepSimulation(toBt(1e-3), 0);
  const double z_m = ring.X_WP().p.z();
  std::printf("the ring lies at %.4f mm: half its height\n", 1e3 * z_m);

  // Bodies leave the world before they are destroyed, and uninstall() removes VPS contact from the
  // dispatcher.
  for (btRigidBody* body : {ring.rigid.get(), &peg, &ground}) world.removeRigidBody(body);
  vps::bullet::uninstall(dispatcher);
  return std::abs(z_m - 0.0025) < 5e-6 ? 0 : 1;
}
