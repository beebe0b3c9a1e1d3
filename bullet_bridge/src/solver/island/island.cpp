// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island/island.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

// Impulse of external torques and forces: angular, then linear.
Vec6 externalImpulse(const btRigidBody& b, double dt_s) {
  return dt_s * stacked(fromBt(b.getTotalTorque()), fromBt(b.getTotalForce()));
}

// Bullet has three approximations of the gyroscopic torque, and each of them dissipates or adds energy. If
// any of these approximations is enabled, the island rotates the body exactly (meanAngularVelocity()).
bool turnsFreely(const btRigidBody& b) {
  constexpr int kAny = BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT | BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD |
                       BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
  return (b.getFlags() & kAny) != 0;
}

Vec3 inertia_kg_m2(const btRigidBody& b) {
  return fromBt(b.getInvInertiaDiagLocal()).cwiseInverse();
}

// Mass matrix of a body with this orientation, and its inverse. Bullet's own tensor is not used: after
// setWorldTransform() it still belongs to the previous orientation.
void setMass(const btRigidBody& b, const Mat3& R, Mat6& mass, Mat6& inverse_mass) {
  const Vec3 inertia = inertia_kg_m2(b);
  mass = inverse_mass = Mat6::Zero();
  mass.topLeftCorner<3, 3>() = R * inertia.asDiagonal() * R.transpose();
  inverse_mass.topLeftCorner<3, 3>() = R * inertia.cwiseInverse().asDiagonal() * R.transpose();
  mass.bottomRightCorner<3, 3>() = Mat3::Identity() / b.getInvMass();
  inverse_mass.bottomRightCorner<3, 3>() = Mat3::Identity() * double(b.getInvMass());
}

btTransform moved(const btTransform& X, const Vec6& by, double dt_s) {
  btTransform to;
  btTransformUtil::integrateTransform(X, toBt(Vec3(by.tail<3>())), toBt(Vec3(by.head<3>())), toBt(dt_s), to);
  return to;
}

// True for bodies with Bullet's continuous collision detection, which sweeps them from the pose that the
// solver leaves to their end pose and may stop them in between.
bool isSweptByBullet(const btRigidBody& b) {
  return b.getCcdSquareMotionThreshold() > 0 && b.getCollisionShape()->isConvex();
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

Vec3 centerOfMass(std::span<const BodyEnd> ends) {
  Vec3 sum = Vec3::Zero();
  double mass_kg = 0;
  for (const BodyEnd& end : ends) {
    sum += end.mass(3, 3) * end.X_WB.p;
    mass_kg += end.mass(3, 3);
  }
  return sum / mass_kg;
}

}  // namespace

Vec3 commonTurn(std::span<const Vec6> momenta, std::span<const BodyEnd> ends) {
  const Vec3 center_W = centerOfMass(ends);
  Vec3 L = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Vec3 r = ends[i].X_WB.p - center_W;
    L += momenta[i].head<3>() + r.cross(Vec3(momenta[i].tail<3>()));
    inertia += ends[i].mass.topLeftCorner<3, 3>() +
               ends[i].mass(3, 3) * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return inertia.llt().solve(L);
}

void addTurn(const Vec3& w_W, std::span<BodyEnd> ends) {
  const Vec3 center_W = centerOfMass(ends);
  for (BodyEnd& end : ends) {
    end.v.head<3>() += w_W;
    end.v.tail<3>() += w_W.cross(end.X_WB.p - center_W);
  }
}

bool Island::takes(const btRigidBody& rigid) {
  const btVector3 one(1, 1, 1), &inverse = rigid.getInvInertiaDiagLocal();
  if (rigid.getLinearFactor() != one || rigid.getAngularFactor() != one) return false;
  // Bullet's convention for a body that cannot rotate is an inverse inertia of zero.
  return !(rigid.getInvMass() > 0) || (inverse.x() > 0 && inverse.y() > 0 && inverse.z() > 0);
}

void Island::clear() {
  bodies.clear();
  index_.clear();
}

void Island::add(btRigidBody& rigid, double dt_s) {
  IslandBody b;
  b.rigid = &rigid;
  const Mat3 R = fromBt(rigid.getWorldTransform()).R;
  Mat6 inverse_mass;
  setMass(rigid, R, b.mass, inverse_mass);
  b.reach_m = reach_m(rigid);
  b.u = velocityOf(rigid);
  b.start = b.u;
  b.external_Ns = externalImpulse(rigid, dt_s);
  Vec6 undisturbed = b.u + inverse_mass * b.external_Ns;
  b.turns_freely = turnsFreely(rigid);
  if (b.turns_freely) {
    const Vec3 w_B = R.transpose() * undisturbed.head<3>();
    const Vec3 change_W = R * (meanAngularVelocity(inertia_kg_m2(rigid), w_B, dt_s) - w_B);
    undisturbed.head<3>() += change_W;
    b.rest_momentum_Nms = -(b.mass.topLeftCorner<3, 3>() * change_W);
  }
  b.momentum = b.mass * undisturbed;
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

btTransform Island::pushed(std::size_t i, std::span<const Vec6> push, double dt_s) const {
  const btTransform& X_WB = bodies[i].rigid->getWorldTransform();
  return push.empty() || push[i].isZero(0) ? X_WB : moved(X_WB, bodies[i].way_share * push[i], dt_s);
}

btTransform Island::endTransform(std::size_t i, std::span<const Vec6> push, double dt_s) const {
  return moved(pushed(i, push, dt_s), bodies[i].way_share * bodies[i].u, dt_s);
}

Pose Island::endPose(const btCollisionObject* object, std::span<const Vec6> push, double dt_s) const {
  const int index = indexOf(object);
  if (index >= 0) return fromBt(endTransform(static_cast<std::size_t>(index), push, dt_s));
  const Vec6 v = fixedVelocity(object);
  return fromBt(v.isZero(0) ? object->getWorldTransform() : moved(object->getWorldTransform(), v, dt_s));
}

void Island::readEnds(std::span<const Vec6> push, double dt_s, std::vector<BodyEnd>& ends) const {
  ends.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const IslandBody& b = bodies[i];
    BodyEnd end;
    end.X_WB = fromBt(endTransform(i, push, dt_s));
    setMass(*b.rigid, end.X_WB.R, end.mass, end.inverse_mass);
    end.v = b.u;
    // The end velocity w1 has the momentum of u plus rest_momentum_Nms: I1 w1 = I0 w + rest.
    const Mat3 turned = b.mass.topLeftCorner<3, 3>() - end.mass.topLeftCorner<3, 3>();
    if (b.turns_freely)
      end.v.head<3>() +=
          end.inverse_mass.topLeftCorner<3, 3>() * (turned * b.u.head<3>() + b.rest_momentum_Nms);
    if (!end.v.allFinite()) end.v = b.u;
    ends.push_back(end);
  }
}

void Island::finish(std::span<const Vec6> push, double dt_s, std::span<const BodyEnd> ends) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    btRigidBody& rigid = *bodies[i].rigid;
    const Vec6 u = bodies[i].way_share * bodies[i].u, &v = ends[i].v;
    rigid.setAngularVelocity(toBt(Vec3(v.head<3>())));
    rigid.setLinearVelocity(toBt(Vec3(v.tail<3>())));
    btTransform start = pushed(i, push, dt_s);
    const btTransform end = endTransform(i, push, dt_s);
    if (u.tail<3>() != v.tail<3>() && !isSweptByBullet(rigid))
      start.setOrigin(end.getOrigin() - rigid.getLinearVelocity() * toBt(dt_s));
    if (u.head<3>() != v.head<3>())
      start.setBasis(moved(btTransform::getIdentity(), v, dt_s).getBasis().transpose() * end.getBasis());
    rigid.setWorldTransform(start);
  }
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

void Island::readSolution(StepSolution& solution) const {
  readVelocities(solution.u);
  solution.momenta.clear();
  for (const IslandBody& b : bodies) solution.momenta.push_back(b.ended());
}

}  // namespace vps::bullet
