// SPDX-License-Identifier: BSD-3-Clause
// A world that used btGImpactMeshShape for a concave part, and the three lines that replace it.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>

#include <cmath>
#include <cstdio>

using vps::bullet::toBt;

namespace {

// Triangles as the host application has them: here a ring with a hole of 10.1 mm.
void fill(btTriangleMesh& triangles) {
  const vps::Mesh ring = vps::makeTube(0.010, 0.00505, 0.005, 128);
  for (const auto& t : ring.triangles)
    triangles.addTriangle(toBt(ring.vertices[t[0]]), toBt(ring.vertices[t[1]]), toBt(ring.vertices[t[2]]));
}

}  // namespace

int main() {
  // The part's triangles, and an ordinary Bullet world.
  btTriangleMesh triangles;
  fill(triangles);
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));

  // Was: btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
  vps::bullet::install(dispatcher);
  // Was: btGImpactMeshShape shape(&triangles);
  //      shape.updateBound();
  //      shape.calculateLocalInertia(mass, inertia);
  //      btRigidBody ring(mass, &motion, &shape, inertia);
  // Now one call makes shape, mass, inertia and body.
  vps::bullet::BodySettings settings;
  settings.X_WP = vps::Pose::translation({0, 0, 0.045});
  const vps::bullet::Body ring = vps::bullet::makeBody(triangles, settings);
  world.addRigidBody(ring.rigid.get());

  // A peg of 10 mm diameter on the ground, both of Bullet's own shapes; nothing changes for them.
  btCylinderShapeZ peg_shape(btVector3(toBt(0.005), toBt(0.005), toBt(0.02)));
  btStaticPlaneShape ground_shape(btVector3(0, 0, 1), 0);
  btRigidBody peg(0, nullptr, &peg_shape), ground(0, nullptr, &ground_shape);
  peg.setWorldTransform(toBt(vps::Pose::translation({0, 0, 0.02})));
  world.addRigidBody(&peg);
  world.addRigidBody(&ground);
  vps::bullet::tuneWorld(world);  // Bullet's parameters for parts of millimetres and grams
  for (int i = 0; i < 1000; ++i) world.stepSimulation(toBt(1e-3), 0);

  const double z_m = ring.X_WP().p.z();
  std::printf("the ring lies at %.4f mm: half its height\n", 1e3 * z_m);
  for (btRigidBody* body : {ring.rigid.get(), &peg, &ground}) world.removeRigidBody(body);
  vps::bullet::uninstall(dispatcher);
  return std::abs(z_m - 0.0025) < 5e-6 ? 0 : 1;
}
