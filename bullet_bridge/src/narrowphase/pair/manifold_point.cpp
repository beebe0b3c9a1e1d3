// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/manifold_writer.h"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "solver/contact_key.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

void positions(const Candidate& c, Vec3& on0, Vec3& on1) {
  on0 = c.side == 0 ? c.p_W : Vec3(c.p_W + c.distance_m * c.n_W);
  on1 = c.side == 1 ? c.p_W : Vec3(c.p_W - c.distance_m * c.n_W);
}

int indexOn(const Candidate& c, int side) {
  if (c.isCrossing() && side == 1) return static_cast<int>(c.crossed - 1);
  return c.side == side ? static_cast<int>(c.id) : -1;
}

namespace {

// Sets the first friction direction along the slip, so that the solver's friction pyramid is exact for a
// sliding part. For a part at rest the direction depends on the normal only, so that noise does not turn it.
void setFrictionDirections(btManifoldPoint& point, const Vec3& n, const Vec3& velocity) {
  const Vec3 slip = velocity - n * n.dot(velocity);
  Vec3 t1;
  if (slip.norm() > kSliding_m_s) {
    t1 = slip.normalized();
  } else {
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    t1 = n.cross(Vec3(Vec3::Unit(least))).normalized();
  }
  point.m_lateralFrictionDir1 = toBt(t1);
  point.m_lateralFrictionDir2 = toBt(Vec3(n.cross(t1)));
  point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
}

bool hasAnisotropicFriction(const btCollisionObject& a, const btCollisionObject& b) {
  return a.hasAnisotropicFriction() || b.hasAnisotropicFriction();
}

// Sets what btManifoldResult::addContactPoint would set from the bodies.
void setMaterial(btManifoldPoint& point, const Candidate& c, const PairMaterial& material,
                 const RelativeMotion& motion, const btCollisionObject* a, const btCollisionObject* b) {
  point.m_combinedFriction = toBt(material.friction(c, motion));
  point.m_combinedRestitution = toBt(material.restitution(c));
  point.m_combinedRollingFriction = btManifoldResult::calculateCombinedRollingFriction(a, b);
  point.m_combinedSpinningFriction = btManifoldResult::calculateCombinedSpinningFriction(a, b);
  const int flags = a->getCollisionFlags() | b->getCollisionFlags();
  if (flags & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) {
    point.m_combinedContactDamping1 = btManifoldResult::calculateCombinedContactDamping(a, b);
    point.m_combinedContactStiffness1 = btManifoldResult::calculateCombinedContactStiffness(a, b);
    point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  }
  if (flags & btCollisionObject::CF_HAS_FRICTION_ANCHOR)
    point.m_contactPointFlags |= BT_CONTACT_FLAG_FRICTION_ANCHOR;
}

}  // namespace

btManifoldPoint makePoint(const Candidate& c, const PairMaterial& material,
                          const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion) {
  Vec3 on0, on1;
  positions(c, on0, on1);
  const btVector3 p0 = toBt(on0), p1 = toBt(on1);
  btManifoldPoint point(bodies[0]->getCollisionObject()->getWorldTransform().invXform(p0),
                        bodies[1]->getCollisionObject()->getWorldTransform().invXform(p1), toBt(c.n_W),
                        toBt(c.distance_m));
  point.m_positionWorldOnA = p0;
  point.m_positionWorldOnB = p1;
  point.m_index0 = indexOn(c, 0);
  point.m_index1 = indexOn(c, 1);
  point.m_partId0 = c.surface[0];
  point.m_partId1 = c.surface[1];
  setMaterial(point, c, material, motion, bodies[0]->getCollisionObject(), bodies[1]->getCollisionObject());
  if (c.rest_m > 0) setRestGap(point, c.rest_m);
  setArea(point, c.area_m2);
  if (c.bounces) setBounces(point);
  setFrictionDirections(point, c.n_W, motion.velocityAt(c.p_W));
  // For anisotropic friction Bullet's solver scales only directions that it chooses itself.
  if (hasAnisotropicFriction(*bodies[0]->getCollisionObject(), *bodies[1]->getCollisionObject()))
    point.m_contactPointFlags &= ~BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
  return point;
}

void copyImpulses(btManifoldPoint& point, const btManifoldPoint& old) {
  point.m_appliedImpulse = old.m_appliedImpulse;
  const btVector3 lateral = old.m_lateralFrictionDir1 * old.m_appliedImpulseLateral1 +
                            old.m_lateralFrictionDir2 * old.m_appliedImpulseLateral2;
  point.m_appliedImpulseLateral1 = lateral.dot(point.m_lateralFrictionDir1);
  point.m_appliedImpulseLateral2 = lateral.dot(point.m_lateralFrictionDir2);
  point.m_lifeTime = old.m_lifeTime + 1;
  point.m_userPersistentData = old.m_userPersistentData;
}

void keepMaterial(btManifoldPoint& point, const btManifoldPoint& old) {
  constexpr int kSoft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                        BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  if ((old.m_contactPointFlags & kSoft) != 0) {
    point.m_contactPointFlags = old.m_contactPointFlags;
    point.m_contactCFM = old.m_contactCFM;
    point.m_contactERP = old.m_contactERP;
  } else {
    point.m_contactPointFlags |= old.m_contactPointFlags & (kOwnDirections | kOwnNormal | kOwnFriction |
                                                            BT_CONTACT_FLAG_FRICTION_ANCHOR);
  }
  point.m_frictionCFM = old.m_frictionCFM;
  // A coefficient that the callback left alone follows the friction model in each step.
  if ((old.m_contactPointFlags & kOwnFriction) != 0) point.m_combinedFriction = old.m_combinedFriction;
  point.m_combinedRollingFriction = old.m_combinedRollingFriction;
  point.m_combinedSpinningFriction = old.m_combinedSpinningFriction;
  point.m_combinedRestitution = old.m_combinedRestitution;
  point.m_contactMotion1 = old.m_contactMotion1;
  point.m_contactMotion2 = old.m_contactMotion2;
  if ((old.m_contactPointFlags & kOwnNormal) != 0) point.m_normalWorldOnB = old.m_normalWorldOnB;
  if ((old.m_contactPointFlags & kOwnDirections) == 0) return;
  point.m_lateralFrictionDir1 = old.m_lateralFrictionDir1;
  point.m_lateralFrictionDir2 = old.m_lateralFrictionDir2;
  point.m_appliedImpulseLateral1 = old.m_appliedImpulseLateral1;
  point.m_appliedImpulseLateral2 = old.m_appliedImpulseLateral2;
}

}  // namespace vps::bullet
