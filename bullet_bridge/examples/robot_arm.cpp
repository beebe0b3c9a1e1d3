// SPDX-License-Identifier: BSD-3-Clause
// A part at the end of a robot arm made of Bullet's btMultiBody: the arm's motor lays a ring on a fixed
// plate.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>

#include <cmath>
#include <cstdio>

using vps::bullet::toBt;

int main() {
  // A Bullet world for multibodies, with VPS contact in its dispatcher.
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;  // links need Bullet's own world and solver
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));
  vps::bullet::install(dispatcher);

  vps::bullet::BodySettings fixed;
  fixed.is_fixed = true;  // the plate's top is at z = 5 mm
  const vps::bullet::Body plate = vps::bullet::makeBody(vps::makeBox({0.06, 0.06, 0.01}), fixed);
  world.addRigidBody(plate.rigid.get());

  // makeBody() gives shape, mass and inertia; the link takes these, and its rigid body is not used.
  const vps::bullet::Body ring = vps::bullet::makeBody(vps::makeTube(0.012, 0.006, 0.01, 64));

  // The robot has a fixed base next to the plate, a slide that moves down, and an arm of 0.1 m whose hinge
  // swings the ring over the plate.
  btMultiBody arm(2, 0, btVector3(0, 0, 0), true, false);
  arm.setBaseWorldTransform(toBt(vps::Pose::translation({-0.1, 0, 0.03})));
  const btQuaternion straight(0, 0, 0, 1);
  const btVector3 light(toBt(1e-5), toBt(1e-5), toBt(1e-5)), none(0, 0, 0);
  arm.setupPrismatic(0, toBt(0.1), light, -1, straight, btVector3(0, 0, 1), none, none, true);
  // The link's frame, like the shape's, has the ring's principal axes; the frame of the ring's mesh is turned
  // against it.
  const vps::Mat3 R_BP = ring.frame.X_PB.R.transpose();
  const btQuaternion into_body = toBt(vps::Pose(R_BP, {0, 0, 0})).getRotation();
  arm.setupRevolute(1, toBt(ring.frame.mass_kg), toBt(ring.frame.inertia_kg_m2), 0, into_body,
                    toBt(vps::Vec3(R_BP * vps::Vec3(0, 0, 1))), none,
                    toBt(vps::Vec3(R_BP * vps::Vec3(0.1, 0, 0))), true);
  arm.finalizeMultiDof();
  world.addMultiBody(&arm);
  // The collider gives the second link the ring's shape.
  btMultiBodyLinkCollider collider(&arm, 1);
  collider.setCollisionShape(ring.shape.get());
  arm.getLink(1).m_collider = &collider;
  world.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter);
  arm.setJointPos(1, toBt(0.5));
  btAlignedObjectArray<btQuaternion> turns;  // the collider's first place; later the world moves it
  btAlignedObjectArray<btVector3> origins;
  arm.forwardKinematics(turns, origins);
  arm.updateCollisionObjectWorldTransforms(turns, origins);
  vps::bullet::tuneWorld(world);

  // The slide moves down, and the hinge turns to its target.
  btMultiBodyJointMotor slide(&arm, 0, toBt(-0.05), toBt(5e-3));  // down at 50 mm/s, with 5 N at most
  btMultiBodyJointMotor hinge(&arm, 1, 0, toBt(1e-3));
  hinge.setPositionTarget(0, toBt(0.02));
  world.addMultiBodyConstraint(&slide);
  world.addMultiBodyConstraint(&hinge);
  double lowest_m = 1;
  for (int i = 0; i < 1500; ++i) {
    world.stepSimulation(toBt(1e-3), 0);
    lowest_m = std::fmin(lowest_m, collider.getWorldTransform().getOrigin().z());
  }
  const double z_m = collider.getWorldTransform().getOrigin().z();
  std::printf("the ring lies %.1f um above the plate, at its deepest %.1f um\n", 1e6 * (z_m - 0.010),
              1e6 * (lowest_m - 0.010));
  world.removeMultiBodyConstraint(&slide);
  world.removeMultiBodyConstraint(&hinge);
  world.removeCollisionObject(&collider);
  world.removeMultiBody(&arm);
  world.removeRigidBody(plate.rigid.get());
  vps::bullet::uninstall(dispatcher);
  return std::abs(z_m - 0.010) < 10e-6 && lowest_m > 0.010 - 10e-6 ? 0 : 1;
}
