// SPDX-License-Identifier: BSD-3-Clause
// A user's program: one VPS part dropped on another in an ordinary Bullet world, from installed
// headers alone.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/install.h>
#include <vps_bullet/shape.h>

#include <cmath>
#include <cstdio>

int main() {
  vps::VoxMapSettings voxels;
  voxels.voxel_m = 0.5e-3;
  vps::PointShellSettings points;
  points.spacing_m = 1e-3;
  const auto part = vps::buildPartModel("block", vps::makeBox(vps::Vec3(0.02, 0.02, 0.01)), voxels, points);

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  vps::bullet::install(dispatcher);
  vps::bullet::tuneWorld(world);
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));

  vps::bullet::Shape shape(vps::bullet::makeModels(*part));
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.03), inertia);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
  btRigidBody block(btRigidBody::btRigidBodyConstructionInfo(btScalar(0.03), nullptr, &shape, inertia));
  block.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(0.012))));
  world.addRigidBody(&floor);
  world.addRigidBody(&block);
  for (int i = 0; i < 500; ++i) world.stepSimulation(btScalar(1e-3), 0);
  const double height_m = block.getWorldTransform().getOrigin().z();
  world.removeRigidBody(&block);
  world.removeRigidBody(&floor);
  vps::bullet::uninstall(dispatcher);

  std::printf("the block rests at %.4f mm (10 mm by geometry)\n", height_m * 1e3);
  return std::abs(height_m - 0.01) < 5e-6
             ? 0
             : 1;  // half a per cent of a voxel, since a flat face has no field error
}
