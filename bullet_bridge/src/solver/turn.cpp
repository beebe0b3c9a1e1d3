// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/turn.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

const btRigidBody* dynamicBody(const btCollisionObject* object) {
  const btRigidBody* body = btRigidBody::upcast(object);
  return body && !body->isStaticOrKinematicObject() ? body : nullptr;
}

Vec3 rotation(const btCollisionObject* object) {
  const btRigidBody* body = btRigidBody::upcast(object);
  return body && !body->isStaticObject() ? fromBt(body->getAngularVelocity()) : Vec3(Vec3::Zero());
}

Vec3 velocityAt(const btCollisionObject* object, const btVector3& p_W) {
  const btRigidBody* body = btRigidBody::upcast(object);
  return body && !body->isStaticObject()
             ? fromBt(body->getVelocityInLocalPoint(p_W - body->getCenterOfMassPosition()))
             : Vec3(Vec3::Zero());
}

double leaving_m_s2(const btPersistentManifold& manifold) {
  const Vec3 w = rotation(manifold.getBody0()) - rotation(manifold.getBody1());
  double most_m_s2 = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const btVector3& p_W = point.getPositionWorldOnB();
    const Vec3 v = velocityAt(manifold.getBody0(), p_W) - velocityAt(manifold.getBody1(), p_W);
    most_m_s2 = std::max(most_m_s2, std::abs(fromBt(point.m_normalWorldOnB).dot(w.cross(v))));
  }
  return most_m_s2;
}

double relativeTurn_rad_s(const btCollisionObject* a, const btCollisionObject* b) {
  return (rotation(a) - rotation(b)).norm();
}

// Bounding box of a body's motion in a step.
void readBox(const btCollisionObject& object, double dt_s, btVector3& min, btVector3& max) {
  object.getCollisionShape()->getAabb(object.getWorldTransform(), min, max);
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || body->isStaticObject()) return;
  const btScalar dt = toBt(dt_s);
  const btVector3 way = dt * (body->getLinearVelocity() +
                              dt * (body->getGravity() + body->getInvMass() * body->getTotalForce()));
  min.setMin(min + way);
  max.setMax(max + way);
}

bool boxesMeet(const btCollisionObject& a, const btCollisionObject& b, double dt_s) {
  btVector3 min[2], max[2];
  readBox(a, dt_s, min[0], max[0]);
  readBox(b, dt_s, min[1], max[1]);
  for (int i = 0; i < 3; ++i)
    if (min[0][i] > max[1][i] || min[1][i] > max[0][i]) return false;
  return true;
}

}  // namespace

void findTurns(btCollisionWorld& world, std::vector<BodyTurn>& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    if (const btRigidBody* body = dynamicBody(world.getCollisionObjectArray()[i]))
      out.push_back({body, false, rotation(body).norm()});
  const auto indexOf = [](const BodyTurn& turn) { return turn.body->getWorldArrayIndex(); };
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    const btCollisionObject* const object[2] = {manifold.getBody0(), manifold.getBody1()};
    if (manifold.getNumContacts() == 0 || !dispatcher.needsResponse(object[0], object[1])) continue;
    const double w_rad_s = relativeTurn_rad_s(object[0], object[1]);
    const double leaving = leaving_m_s2(manifold);
    for (const btCollisionObject* each : object) {
      const auto found =
          std::ranges::lower_bound(out.begin() + first, out.end(), each->getWorldArrayIndex(), {}, indexOf);
      if (found == out.end() || found->body != each) continue;
      found->leaving_m_s2 = std::max(found->leaving_m_s2, leaving);
      if (const BodyTurn in_contact{found->body, true, w_rad_s, found->leaving_m_s2};
          in_contact.rate_hz() > found->rate_hz())
        *found = in_contact;
    }
  }
}

int substepsFor(btCollisionWorld& world, double dt_s, int most) {
  double rate_hz = 0;
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    if (const btRigidBody* body = dynamicBody(world.getCollisionObjectArray()[i]))
      rate_hz = std::max(rate_hz, rotation(body).norm() / kBulletTurn_rad);
  btDispatcher& dispatcher = *world.getDispatcher();
  const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    const auto* a = static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject);
    const auto* b = static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject);
    const double needed_hz = relativeTurn_rad_s(a, b) / kContactTurn_rad;
    if (needed_hz > rate_hz && dispatcher.needsCollision(a, b) && dispatcher.needsResponse(a, b) &&
        boxesMeet(*a, *b, dt_s))
      rate_hz = needed_hz;
  }
  const double count = std::ceil(rate_hz * dt_s);
  return count < most ? std::max(1, static_cast<int>(count)) : std::max(1, most);
}

}  // namespace vps::bullet
