// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::dynamics {

namespace {

const Vec3 kBlock_m(20e-3, 15e-3, 10e-3);

const PartMesh& blockPart() {
  static const PartMesh part = makePart(makeBox(kBlock_m));
  return part;
}

int responsesOf(World& world, const btRigidBody& body) {
  int count = 0;
  btDispatcher& dispatcher = *world.bullet().getDispatcher();
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    const btCollisionObject *a = manifold.getBody0(), *b = manifold.getBody1();
    if ((a == &body || b == &body) && dispatcher.needsResponse(a, b)) count += manifold.getNumContacts();
  }
  return count;
}

// Half of the penalty energy of the points of `side` that lie inside the other part.
double halfEnergy_J(const Placed& side, const Placed& other) {
  const auto* shape = dynamic_cast<const bullet::Shape*>(side.body->getCollisionShape());
  if (!shape) return 0;
  const double k_N_per_m3 = bullet::Settings().stiffness_N_per_m3;
  const PointShell& shell = *shape->models().shell;
  const Pose X_OP = other.pose().inverse() * side.pose();
  double sum_J = 0;
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const double depth_m = -other.part.exact->signedDistance(X_OP * shell.points[i]);
    if (depth_m > 0) sum_J += 0.5 * k_N_per_m3 * shell.area_m2[i] * depth_m * depth_m;
  }
  return 0.5 * sum_J;
}
double overlapEnergy_J(const Placed& a, const Placed& b) {
  return halfEnergy_J(a, b) + halfEnergy_J(b, a);
}

}  // namespace

CreatedInsideResult createInside(const SceneSettings& settings, double depth_m) {
  World world(settings);
  world.setGravity(Vec3::Zero());
  const Placed fixed = world.add(blockPart(), Pose(), true);
  // The block is slightly rotated, so that no faces are parallel; its lowest corner is near the middle of the
  // fixed block's top face.
  const Mat3 R = rotationFromVector(Vec3(0.05, 0.03, 0.2));
  Vec3 lowest(0, 0, 1e300);
  for (const Vec3& p : blockPart().mesh.vertices)
    if ((R * p).z() < lowest.z()) lowest = R * p;
  const Vec3 corner(2e-3, 1e-3, kBlock_m.z() / 2 - depth_m);
  const Placed block = world.add(blockPart(), Pose(R, corner - lowest));
  CreatedInsideResult result;
  result.overlap_m = penetration_m(fixed.part, Pose(), block.part, block.pose());
  result.overlap_J = overlapEnergy_J(fixed, block);
  for (int i = 0; i < 1000; ++i) {
    const Pose before = block.pose();
    world.step();
    const Pose after = block.pose();
    result.kinetic_J = std::max(result.kinetic_J, kineticEnergy_J(*block.body));
    for (const Vec3& p : blockPart().mesh.vertices)
      result.speed_m_s = std::max(result.speed_m_s, (after * p - before * p).norm() / World::kStep_s);
  }
  // When the bodies are far apart, no vertex is near enough for a depth.
  result.left_m = std::max(0.0, penetration_m(fixed.part, Pose(), block.part, block.pose()));
  return result;
}

ProxyResult leadProxyThrough(const SceneSettings& settings) {
  static const PartMesh plate = makePart(makeBox(Vec3(60e-3, 60e-3, 5e-3)));
  World world(settings);
  world.setGravity(Vec3::Zero());
  // From above: the part in hand, a fixed plate (its top is z = 0), a free part; the proxy moves through all
  // of them.
  world.add(plate, Pose::translation(Vec3(0, 0, -2.5e-3)), true);
  const Placed below = world.add(blockPart(), Pose::translation(Vec3(0, 0, -15e-3)));
  const Placed hand = world.add(blockPart(), Pose::translation(Vec3(0, 0, 15e-3)));
  // The proxy is added as a user would add it: a kinematic body with the part's shape.
  bullet::BodyFrame massless = blockPart().frame;
  massless.mass_kg = 0;
  btRigidBody* proxy = world.addShape(settings.engine.makeShape(blockPart(), false), massless,
                                      bullet::fromBt(hand.body->getWorldTransform()));
  proxy->setCollisionFlags(proxy->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  auto coupling =
      std::make_unique<bullet::CouplingConstraint>(*proxy, Pose(), *hand.body, Pose(), CouplingGains{});
  world.addConstraint(std::move(coupling));

  ProxyResult result;
  const Vec3 rest = below.pose().p;
  btDefaultMotionState motion(proxy->getWorldTransform());
  proxy->setMotionState(&motion);
  for (int i = 0; i < 500; ++i) {
    motion.m_graphicsWorldTrans.getOrigin().setZ(btScalar(15e-3 - 0.1e-3 * i));
    world.step();
    result.responses = std::max(result.responses, responsesOf(world, *proxy));
    result.disturbed_m = std::max(result.disturbed_m, (below.pose().p - rest).norm());
  }
  result.held_m = hand.pose().p.z() - kBlock_m.z() / 2;
  proxy->setMotionState(nullptr);
  return result;
}

WallResult shootAtWall(const SceneSettings& settings, double speed_m_s, bool is_turned) {
  static const PartMesh wall = makePart(makeBox(Vec3(2e-3, 60e-3, 60e-3)));
  World world(settings);
  world.setGravity(Vec3::Zero());
  const Placed fixed = world.add(wall, Pose::translation(Vec3(1e-3, 0, 0)), true);  // its face is x = 0
  const Vec3 turn = is_turned ? Vec3(0.2, 0.1, 0.3) : Vec3(Vec3::Zero());
  const Placed block = world.add(blockPart(), Pose(rotationFromVector(turn), Vec3(-0.2, 1e-3, 2e-3)));
  block.body->setLinearVelocity(btVector3(btScalar(speed_m_s), 0, 0));
  WallResult result;
  result.deepest_m = -1e300;
  result.beyond_m = -1e300;
  const int steps = static_cast<int>(0.2 / speed_m_s / World::kStep_s) + 200;
  for (int i = 0; i < steps; ++i) {
    world.step();
    result.deepest_m =
        std::max(result.deepest_m, penetration_m(fixed.part, fixed.pose(), block.part, block.pose()));
    // If the part has not passed through the wall, its centre stays in front of the wall's face.
    result.beyond_m = std::max(result.beyond_m, block.pose().p.x());
  }
  result.speed_m_s = block.body->getLinearVelocity().length();
  return result;
}

}  // namespace vps::dynamics
