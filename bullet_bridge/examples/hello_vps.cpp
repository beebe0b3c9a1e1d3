// SPDX-License-Identifier: BSD-3-Clause
// One VPS part in an ordinary Bullet world: a ring drops over a peg. Stock Bullet would close the ring's
// hole.
#include <btBulletDynamicsCommon.h>

#include <cstdio>

#include "vps_bullet/convert.h"
#include "vps_bullet/install.h"
#include "vps_bullet/shape.h"

int main() {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  vps::installVps(dispatcher);  // from here on, VpsShapes collide
  vps::tuneWorld(world);        // and parts of millimetres and grams rest still
  world.setGravity(btVector3(0, 0, vps::toBt(-9.81)));

  // The part: a steel ring with a hole of 10.1 mm. A mesh is all it takes.
  vps::Part ring;
  ring.mesh = vps::makeTube(0.010, 0.00505, 0.005, 128);
  ring.map = std::make_shared<const vps::VoxMap>(vps::buildVoxMap(ring.mesh, {}));
  ring.shell = std::make_shared<const vps::PointShell>(vps::buildPointShell(ring.mesh, {}));
  const vps::BodyFrame frame =
      vps::makeBodyFrame(vps::massProperties(ring.mesh), ring.material.density_kg_m3);
  vps::VpsShape ring_shape(vps::makeModels(ring), frame.X_PB.inverse());
  btRigidBody body(vps::toBt(frame.mass_kg), nullptr, &ring_shape, vps::toBt(frame.inertia_kg_m2));
  body.setWorldTransform(vps::toBt(vps::Pose::translation({0, 0, 0.045}) * frame.X_PB));

  // The rest is plain Bullet: a peg of 10 mm that stands on the ground.
  btCylinderShapeZ peg_shape(btVector3(vps::toBt(0.005), vps::toBt(0.005), vps::toBt(0.02)));
  btStaticPlaneShape ground_shape(btVector3(0, 0, 1), 0);
  btRigidBody peg(0, nullptr, &peg_shape), ground(0, nullptr, &ground_shape);
  peg.setWorldTransform(vps::toBt(vps::Pose::translation({0, 0, 0.02})));

  for (btRigidBody* b : {&body, &peg, &ground}) world.addRigidBody(b);
  for (int i = 0; i < 1000; ++i) world.stepSimulation(vps::toBt(1e-3), 0);
  std::printf("the ring lies at %.4f mm: half its height\n", 1e3 * body.getWorldTransform().getOrigin().z());
  for (btRigidBody* b : {&body, &peg, &ground}) world.removeRigidBody(b);
  vps::uninstallVps(dispatcher);
}
