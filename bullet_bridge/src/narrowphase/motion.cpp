// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/motion.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet::inline v0 {

Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings) {
  Twist V;
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

}  // namespace vps::bullet::inline v0
