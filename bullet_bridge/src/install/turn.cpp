// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/turn.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {

namespace {

const btRigidBody* dynamicBody(const btCollisionObject* object) {
  const btRigidBody* body = btRigidBody::upcast(object);
  return body && !body->isStaticOrKinematicObject() ? body : nullptr;
}

Vec3 rotation(const btCollisionObject* object) {
  const btRigidBody* body = btRigidBody::upcast(object);
  return body && !body->isStaticObject() ? fromBt(body->getAngularVelocity()) : Vec3(Vec3::Zero());
}

double relativeTurn_rad_s(const btCollisionObject* a, const btCollisionObject* b) {
  return (rotation(a) - rotation(b)).norm();
}

bool boxesOverlap(const btCollisionObject& a, const btCollisionObject& b) {
  btVector3 min[2], max[2];
  a.getCollisionShape()->getAabb(a.getWorldTransform(), min[0], max[0]);
  b.getCollisionShape()->getAabb(b.getWorldTransform(), min[1], max[1]);
  for (int i = 0; i < 3; ++i)
    if (min[0][i] > max[1][i] || min[1][i] > max[0][i]) return false;
  return true;
}

}  // namespace

void findTurns(btCollisionWorld& world, std::vector<BodyTurn>& out) {
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> place(static_cast<std::size_t>(world.getNumCollisionObjects()), kNone);
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    if (const btRigidBody* body = dynamicBody(world.getCollisionObjectArray()[i])) {
      place[static_cast<std::size_t>(i)] = out.size();
      out.push_back({body, false, rotation(body).norm()});
    }
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    const btCollisionObject* const object[2] = {manifold.getBody0(), manifold.getBody1()};
    const double w_rad_s = relativeTurn_rad_s(object[0], object[1]);
    for (const btCollisionObject* each : object) {
      const auto index = static_cast<std::size_t>(each->getWorldArrayIndex());
      if (index >= place.size() || place[index] == kNone) continue;
      BodyTurn& turn = out[place[index]];
      if (const BodyTurn in_contact{turn.body, true, w_rad_s}; in_contact.rate_hz() > turn.rate_hz())
        turn = in_contact;
    }
  }
}

int substepsFor(btCollisionWorld& world, double dt_s, int most) {
  double rate_hz = 0;
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    if (const btRigidBody* body = dynamicBody(world.getCollisionObjectArray()[i]))
      rate_hz = std::max(rate_hz, rotation(body).norm() / kBulletTurn_rad);
  const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    const auto* a = static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject);
    const auto* b = static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject);
    const double needed_hz = relativeTurn_rad_s(a, b) / kContactTurn_rad;
    if (needed_hz > rate_hz && boxesOverlap(*a, *b)) rate_hz = needed_hz;
  }
  const double count = std::ceil(rate_hz * dt_s);
  return count < most ? std::max(1, static_cast<int>(count)) : std::max(1, most);
}

}  // namespace vps::bullet::inline v0
