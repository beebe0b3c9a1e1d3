// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/coupling.h"

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// Bullet casts a constraint by type when it draws or saves it, and ignores unknown types.
constexpr btTypedConstraintType kNoStockType = MAX_CONSTRAINT_TYPE;

void requireDynamic(const btRigidBody& part) {
  if (!(part.getInvMass() > 0))
    throw std::invalid_argument("CouplingConstraint: the part in hand has no mass; give its body a mass");
}

void requireUsable(const CouplingGains& g) {
  for (const double value :
       {g.k_N_per_m, g.b_Ns_per_m, g.k_Nm_per_rad, g.b_Nms_per_rad, g.max_force_N, g.max_torque_Nm})
    if (!(value >= 0) || !std::isfinite(value))
      throw std::invalid_argument("CouplingConstraint: every gain and limit must be finite and not negative");
}

}  // namespace

CouplingConstraint::CouplingConstraint(btRigidBody& part, const Pose& X_BG, const CouplingGains& gains)
    : btTypedConstraint(kNoStockType, part), part_(part), X_BG_(X_BG) {
  requireDynamic(part);
  setGains(gains);
}

CouplingConstraint::CouplingConstraint(btRigidBody& proxy, const Pose& X_AG, btRigidBody& part,
                                       const Pose& X_BG, const CouplingGains& gains)
    : btTypedConstraint(kNoStockType, part, proxy), part_(part), proxy_(&proxy), X_AG_(X_AG), X_BG_(X_BG) {
  requireDynamic(part);
  if (!proxy.isStaticOrKinematicObject())
    throw std::invalid_argument(
        "CouplingConstraint: the proxy must be kinematic; set CF_KINEMATIC_OBJECT on it");
  // The proxy represents the hand, which may move where walls stop the part; only the part collides.
  proxy.setCollisionFlags(proxy.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  setGains(gains);
}

void CouplingConstraint::setGains(const CouplingGains& gains) {
  requireUsable(gains);
  gains_ = gains;
}

void CouplingConstraint::setTarget(const CouplingState& target) {
  target_ = target;
  if (target_.is_coupled) part_.activate();
}

void CouplingConstraint::release() {
  target_.is_coupled = false;
  proxy_ = nullptr;
  F_PG_W_ = Wrench();
}

CouplingState CouplingConstraint::partState() const {
  CouplingState state;
  const Pose X_WB = fromBt(part_.getWorldTransform());
  state.X_W = X_WB * X_BG_;
  state.V_W.w = fromBt(part_.getAngularVelocity());
  state.V_W.v = fromBt(part_.getLinearVelocity()) + state.V_W.w.cross(state.X_W.p - X_WB.p);
  state.time_s = target_.time_s;
  state.is_coupled = target_.is_coupled;
  return state;
}

CouplingState CouplingConstraint::currentTarget() const {
  if (target_.is_coupled || !proxy_) return target_;
  // A kinematic body's world transform is already that of the end of the step
  // (btRigidBody::saveKinematicState).
  CouplingState target;
  const Pose X_WA = fromBt(proxy_->getWorldTransform());
  target.X_W = X_WA * X_AG_;
  target.V_W.w = fromBt(proxy_->getAngularVelocity());
  target.V_W.v = fromBt(proxy_->getLinearVelocity()) + target.V_W.w.cross(target.X_W.p - X_WA.p);
  target.is_coupled = true;
  return target;
}

CouplingConstraint::Step CouplingConstraint::makeStep(double dt_s) const {
  Step step;
  const CouplingState target = currentTarget();
  const CouplingState part = partState();
  step.is_open = !target.is_coupled || !target.X_W.isFinite() || !target.V_W.isFinite() ||
                 !part.X_W.isFinite() || !part.V_W.isFinite() || !(dt_s > 0);
  if (step.is_open) return step;
  step.dt_s = dt_s;
  step.r_W = part.X_W.p - fromBt(part_.getWorldTransform().getOrigin());
  step.error << rotationVector(target.X_W.R * part.X_W.R.transpose()), target.X_W.p - part.X_W.p;
  step.V_target << target.V_W.w, target.V_W.v;
  // A = J M^-1 J^T, with J = [1 0; -[r] 1] from the body's twist at its centre to that at the grasp point.
  const Mat3 rx = crossMatrix(step.r_W);
  const Mat3 I_inv = fromBt(part_.getAngularFactor()).asDiagonal() * fromBt(part_.getInvInertiaTensorWorld());
  const Mat3 m_inv = (part_.getInvMass() * fromBt(part_.getLinearFactor())).asDiagonal();
  step.A.topLeftCorner<3, 3>() = I_inv;
  step.A.topRightCorner<3, 3>() = I_inv * rx;
  step.A.bottomLeftCorner<3, 3>() = -rx * I_inv;
  step.A.bottomRightCorner<3, 3>() = m_inv - rx * I_inv * rx;
  return step;
}

CouplingConstraint::Law CouplingConstraint::lawAt(const Step& step, const Vec6& V_G, bool unlimited) const {
  // At the end of the step the error is e - dt V (the target is that of the end), so the law gives
  // impulse = dt k (e - dt V) + dt b (V_target - V) where the first term, the spring, is limited.
  Law law;
  const double dt = step.dt_s;
  const double k[2] = {gains_.k_Nm_per_rad, gains_.k_N_per_m},
               b[2] = {gains_.b_Nms_per_rad, gains_.b_Ns_per_m};
  const double limit[2] = {gains_.max_torque_Nm * dt, gains_.max_force_N * dt};
  for (int half = 0; half < 2; ++half) {
    const auto e = step.error.segment<3>(3 * half);
    const Vec3 damper = dt * b[half] * step.V_target.segment<3>(3 * half);
    const Vec3 spring = dt * k[half] * (e - dt * V_G.segment<3>(3 * half));
    const bool is_limited = !unlimited && spring.norm() > limit[half];
    if (is_limited) law.limited |= 1 << half;
    law.c.segment<3>(3 * half) =
        damper + (is_limited ? Vec3(limit[half] * spring.normalized()) : Vec3(dt * k[half] * e));
    law.D.segment<3>(3 * half).setConstant(dt * (b[half] + (is_limited ? 0 : dt * k[half])));
  }
  return law;
}

CouplingConstraint::Vec6 CouplingConstraint::solveImpulse(const Step& step, const Vec6& V_without) const {
  // Solves V = V_without + A (c - D V). At a limit the law depends on V: its direction converges in a few
  // rounds, whose fixed number bounds the cost.
  constexpr int kRounds = 4;  // assumed; the direction turns by less than dt * velocity / error a round
  Law law = lawAt(step, V_without, true);
  Vec6 V;
  for (int round = 0; round < kRounds; ++round) {
    const Mat6 lhs = Mat6::Identity() + step.A * law.D.asDiagonal();
    V = lhs.partialPivLu().solve(V_without + step.A * law.c);
    const Law next = lawAt(step, V);
    if (next.limited == 0 && law.limited == 0) break;
    law = next;
  }
  return law.c - law.D.cwiseProduct(V);
}

Twist CouplingConstraint::freeVelocity(double dt_s) const {
  const Step step = makeStep(dt_s);
  if (step.is_open) return {};
  const Vec3 w = fromBt(part_.getAngularVelocity() +
                        part_.getInvInertiaTensorWorld() * part_.getTotalTorque() * toBt(dt_s));
  const Vec3 v =
      fromBt(part_.getLinearVelocity() + part_.getTotalForce() * (part_.getInvMass() * toBt(dt_s)));
  Vec6 V_without;
  V_without << w, v + w.cross(step.r_W);
  const Vec6 impulse = solveImpulse(step, V_without);
  const Vec3 torque = impulse.head<3>() + step.r_W.cross(impulse.tail<3>());
  return {fromBt(part_.getInvInertiaTensorWorld() * toBt(torque)),
          part_.getInvMass() * Vec3(impulse.tail<3>())};
}

const char* CouplingConstraint::unsupportedReason(const btConstraintSolver& solver) {
  if (solver.getSolverType() == BT_SEQUENTIAL_IMPULSE_SOLVER) return nullptr;
  return "CouplingConstraint needs btSequentialImpulseConstraintSolver or Solver: this solver never calls "
         "solveConstraintObsolete, so the coupling would give no force";
}

void CouplingConstraint::buildJacobian() {
  is_prepared_ = false;  // the step size is known only at the first iteration
  impulse_.setZero();
  F_PG_W_ = Wrench();
}

void CouplingConstraint::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 0;
  info->nub = 0;
}

void CouplingConstraint::getInfo2(btConstraintInfo2*) {}

void CouplingConstraint::setImpulse(const Vec6& impulse, double dt_s) {
  impulse_ = impulse;
  F_PG_W_ = {impulse.head<3>() / dt_s, impulse.tail<3>() / dt_s};
}

void CouplingConstraint::solveConstraintObsolete(btSolverBody& part, btSolverBody&, btScalar dt_s) {
  if (!is_prepared_) {
    step_ = makeStep(dt_s);
    is_prepared_ = true;
  }
  if (step_.is_open) return;
  const Vec3 w =
      fromBt(part.m_angularVelocity + part.m_externalTorqueImpulse + part.getDeltaAngularVelocity());
  const Vec3 v = fromBt(part.m_linearVelocity + part.m_externalForceImpulse + part.getDeltaLinearVelocity());
  Vec6 V_G;
  V_G << w, v + w.cross(step_.r_W);
  const Vec6 impulse = solveImpulse(step_, V_G - step_.A * impulse_);
  const Vec6 change = impulse - impulse_;
  setImpulse(impulse, dt_s);
  const btVector3 force = toBt(Vec3(change.tail<3>()));
  const btVector3 torque = toBt(Vec3(change.head<3>() + step_.r_W.cross(change.tail<3>())));
  part.internalApplyImpulse(force * part_.getInvMass(), part_.getInvInertiaTensorWorld() * torque, 1);
}

// Gains are set by setGains(); Bullet's numbered parameters (ERP, CFM) have no effect.
void CouplingConstraint::setParam(int, btScalar, int) {}
btScalar CouplingConstraint::getParam(int, int) const {
  return 0;
}

}  // namespace vps::bullet
