// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/motion.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet {

namespace {

// Velocity of a link about its centre, in W. Its joints will hold back what its own forces give it; that is a
// step's share of gravity, and at most makes a contact known early.
Twist linkVelocity(const btMultiBodyLinkCollider& collider, double dt_s) {
  const btMultiBody& multi = *collider.m_multiBody;
  const int link = collider.m_link;
  Twist V;
  if (link < 0) {
    V.w = fromBt(multi.getBaseOmega());
    V.v = fromBt(multi.getBaseVel());
    if (!multi.hasFixedBase() && multi.getBaseMass() > 0)
      V.v += dt_s / multi.getBaseMass() * fromBt(multi.getBaseForce());
    return V;
  }
  thread_local btAlignedObjectArray<btVector3> w, v;  // of base and links, each in its own frame
  w.resize(multi.getNumLinks() + 1);
  v.resize(multi.getNumLinks() + 1);
  multi.compTreeLinkVelocities(&w[0], &v[0]);
  V.w = fromBt(multi.localDirToWorld(link, w[link + 1]));
  V.v = fromBt(multi.localDirToWorld(link, v[link + 1]));
  if (multi.getLinkMass(link) > 0) V.v += dt_s / multi.getLinkMass(link) * fromBt(multi.getLinkForce(link));
  return V;
}

}  // namespace

Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings) {
  Twist V;
  if (const auto* link = btMultiBodyLinkCollider::upcast(&object); link && link->m_multiBody) {
    V = linkVelocity(*link, dt_s);
    V.v -= V.w.cross(fromBt(object.getWorldTransform().getOrigin()));
    return V;
  }
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || body->isStaticObject()) return V;
  V.w = fromBt(body->getAngularVelocity());
  V.v = fromBt(body->getLinearVelocity());
  if (!body->isKinematicObject()) {
    V.v += dt_s * fromBt(body->getTotalForce() * (body->getInvMass() * body->getLinearFactor()));
    V.w += dt_s * fromBt(body->getInvInertiaTensorWorld() * body->getTotalTorque());
    // The reference list holds the constraints added with world.addConstraint(coupling, true).
    for (int i = 0; with_couplings && i < const_cast<btRigidBody*>(body)->getNumConstraintRefs(); ++i) {
      const auto* coupling =
          dynamic_cast<const CouplingConstraint*>(const_cast<btRigidBody*>(body)->getConstraintRef(i));
      if (coupling && coupling->isEnabled()) {
        const Twist pull = coupling->freeVelocity(dt_s);
        V.w += pull.w;
        V.v += pull.v;
      }
    }
  }
  V.v -= V.w.cross(fromBt(object.getWorldTransform().getOrigin()));
  return V;
}

Pose displacement(const btCollisionObject& object, const Twist& V, double t_s) {
  const Vec3 center = fromBt(object.getWorldTransform().getOrigin());
  const Mat3 R = rotationFromVector(V.w * t_s);
  return {R, center + (V.v + V.w.cross(center)) * t_s - R * center};
}

}  // namespace vps::bullet
