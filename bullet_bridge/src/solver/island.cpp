// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {
namespace {

// As initSolverBody and convertBodies of the stock solver: forces, torques, gyroscopic terms.
Vec6 externalVelocity(const btRigidBody& b, double dt_s) {
  Vec3 w = fromBt(b.getInvInertiaTensorWorld() * b.getTotalTorque()) * dt_s;
  const Vec3 v = fromBt(b.getTotalForce()) * b.getInvMass() * dt_s;
  const int flags = b.getFlags();
  const btScalar dt = toBt(dt_s);
  if (flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY)
    w += fromBt(b.computeGyroscopicImpulseImplicit_Body(dt));
  else if (flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD)
    w += fromBt(b.computeGyroscopicImpulseImplicit_World(dt));
  else if (flags & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT)
    w -= fromBt(b.getInvInertiaTensorWorld() * b.computeGyroscopicForceExplicit(100)) * dt_s;
  return stacked(w, v);
}

// Greatest distance of the body's points from its origin.
double reach_m(const btRigidBody& b) {
  btVector3 center;
  btScalar radius_m = 0;
  b.getCollisionShape()->getBoundingSphere(center, radius_m);
  return center.length() + radius_m;
}

Vec6 velocityOf(const btRigidBody& rigid) {
  return stacked(fromBt(rigid.getAngularVelocity()), fromBt(rigid.getLinearVelocity()));
}

}  // namespace

void Island::clear() {
  bodies.clear();
  index_.clear();
}

void Island::add(btRigidBody& rigid, double dt_s) {
  IslandBody b;
  b.rigid = &rigid;
  b.mass.topLeftCorner<3, 3>() = fromBt(rigid.getInvInertiaTensorWorld()).inverse();
  b.mass.bottomRightCorner<3, 3>() = Mat3::Identity() / rigid.getInvMass();
  b.reach_m = reach_m(rigid);
  b.u = velocityOf(rigid);
  b.momentum = b.mass * (b.u + externalVelocity(rigid, dt_s));
  index_[&rigid] = static_cast<int>(bodies.size());
  bodies.push_back(b);
}

int Island::indexOf(const btCollisionObject* object) const {
  const auto it = index_.find(object);
  return it == index_.end() ? -1 : it->second;
}

Vec6 Island::fixedVelocity(const btCollisionObject* object) {
  const btRigidBody* rigid = btRigidBody::upcast(object);
  return rigid ? velocityOf(*rigid) : Vec6(Vec6::Zero());
}

Pose Island::endPose(const btCollisionObject* object, std::span<const Vec6> push, double dt_s) const {
  btTransform X_WB = object->getWorldTransform();
  const auto move = [&](const Vec6& by) {
    btTransform moved;
    btTransformUtil::integrateTransform(X_WB, toBt(Vec3(by.tail<3>())), toBt(Vec3(by.head<3>())), toBt(dt_s),
                                        moved);
    X_WB = moved;
  };
  const int index = indexOf(object);
  if (index < 0) {
    if (const Vec6 v = fixedVelocity(object); !v.isZero(0)) move(v);
    return fromBt(X_WB);
  }
  const auto i = static_cast<std::size_t>(index);
  if (!push.empty() && !push[i].isZero(0)) move(push[i]);
  move(bodies[i].u);
  return fromBt(X_WB);
}

double Island::topSpeed(std::span<const Vec6> twists) const {
  double top_m_s = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double here_m_s = twists[i].tail<3>().norm() + twists[i].head<3>().norm() * bodies[i].reach_m;
    if (!std::isfinite(here_m_s)) return std::numeric_limits<double>::infinity();
    top_m_s = std::max(top_m_s, here_m_s);
  }
  return top_m_s;
}

void Island::readVelocities(std::vector<Vec6>& u) const {
  u.clear();
  for (const IslandBody& b : bodies) u.push_back(b.u);
}

void Island::writeVelocities() const {
  for (const IslandBody& b : bodies) {
    b.rigid->setAngularVelocity(toBt(Vec3(b.u.head<3>())));
    b.rigid->setLinearVelocity(toBt(Vec3(b.u.tail<3>())));
  }
}

}  // namespace vps::bullet::inline v0
