// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island/joint_rows.h"

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

/// A row in the layout that btTypedConstraint::getInfo2() fills.
struct BulletRow {
  btScalar linear[2][4] = {}, angular[2][4] = {};
  btScalar error = 0, cfm = 0, lower = -SIMD_INFINITY, upper = SIMD_INFINITY;
};
static_assert(sizeof(BulletRow) % sizeof(btScalar) == 0);

Vec6 jacobianOf(const BulletRow& row, int side) {
  const auto vec = [](const btScalar* v) { return Vec3(v[0], v[1], v[2]); };
  return stacked(vec(row.angular[side]), vec(row.linear[side]));
}

/// Adds a row's force and torque on each body to the joint's feedback.
void addFeedback(btJointFeedback& feedback, const JointRow& row, double dt_s) {
  const auto force = [&](int side) { return toBt(Vec3(row.J[side].tail<3>() * (row.impulse_Ns / dt_s))); };
  const auto torque = [&](int side) { return toBt(Vec3(row.J[side].head<3>() * (row.impulse_Ns / dt_s))); };
  feedback.m_appliedForceBodyA += force(0);
  feedback.m_appliedTorqueBodyA += torque(0);
  feedback.m_appliedForceBodyB += force(1);
  feedback.m_appliedTorqueBodyB += torque(1);
}

}  // namespace

double JointRow::inverseMass(const Island& island, Vec6 (*MinvJ)[2]) const {
  double W = 0;
  for (int i = 0; i < 2; ++i) {
    if (body[i] < 0) continue;
    const Vec6 each = island.bodies[static_cast<std::size_t>(body[i])].effective_inverse * J[i];
    W += J[i].dot(each);
    if (MinvJ) (*MinvJ)[i] = each;
  }
  return W;
}

void JointRows::add(btTypedConstraint& joint, const Island& island, const btContactSolverInfo& info) {
  joint.buildJacobian();
  joint.internalSetAppliedImpulse(0);
  if (btJointFeedback* feedback = joint.getJointFeedback()) {
    feedback->m_appliedForceBodyA = feedback->m_appliedForceBodyB = btVector3(0, 0, 0);
    feedback->m_appliedTorqueBodyA = feedback->m_appliedTorqueBodyB = btVector3(0, 0, 0);
  }
  btTypedConstraint::btConstraintInfo1 size{};
  joint.getInfo1(&size);
  if (size.m_numConstraintRows <= 0) return;
  std::vector<BulletRow> bullet_rows(static_cast<std::size_t>(size.m_numConstraintRows));
  for (BulletRow& row : bullet_rows) row.cfm = info.m_globalCfm;
  btTypedConstraint::btConstraintInfo2 request{};
  request.fps = 1 / info.m_timeStep;
  request.erp = info.m_erp;
  request.m_numIterations = info.m_numIterations;
  request.m_damping = info.m_damping;
  BulletRow& first = bullet_rows.front();
  request.m_J1linearAxis = first.linear[0];
  request.m_J2linearAxis = first.linear[1];
  request.m_J1angularAxis = first.angular[0];
  request.m_J2angularAxis = first.angular[1];
  request.m_constraintError = &first.error;
  request.cfm = &first.cfm;
  request.m_lowerLimit = &first.lower;
  request.m_upperLimit = &first.upper;
  request.rowskip = sizeof(BulletRow) / sizeof(btScalar);
  joint.getInfo2(&request);

  const btCollisionObject* const objects[2] = {&joint.getRigidBodyA(), &joint.getRigidBodyB()};
  const double breaking_Ns = joint.getBreakingImpulseThreshold();
  for (const BulletRow& from : bullet_rows) {
    JointRow row;
    row.joint = &joint;
    row.target = from.error;
    row.cfm = from.cfm;
    row.lower_Ns = std::max<double>(from.lower, -breaking_Ns);
    row.upper_Ns = std::min<double>(from.upper, breaking_Ns);
    for (int side = 0; side < 2; ++side) {
      row.J[side] = jacobianOf(from, side);
      row.body[side] = island.indexOf(objects[side]);
      if (row.body[side] < 0) row.fixed_velocity += row.J[side].dot(Island::fixedVelocity(objects[side]));
    }
    if (row.body[0] >= 0 || row.body[1] >= 0) rows.push_back(row);
  }
}

void JointRows::hold(const Island& island, std::span<BodyEnd> ends) {
  double most = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < kMostIterations && most > kRoundingSpeed_m_s; ++sweep) {
    most = 0;
    for (JointRow& row : rows) {
      if (row.isBounded()) continue;
      double error = 0, W = 0;
      Vec6 MinvJ[2];
      for (int i = 0; i < 2; ++i) {
        if (row.body[i] < 0) continue;
        const auto body = static_cast<std::size_t>(row.body[i]);
        error += row.J[i].dot(island.bodies[body].u - ends[body].v);
        MinvJ[i] = ends[body].inverse_mass * row.J[i];
        W += row.J[i].dot(MinvJ[i]);
      }
      if (!(std::abs(error) > kRoundingSpeed_m_s) || !(W > 0)) continue;
      row.impulse_Ns += error / W;
      for (int i = 0; i < 2; ++i)
        if (row.body[i] >= 0) ends[static_cast<std::size_t>(row.body[i])].v += error / W * MinvJ[i];
      most = std::max(most, std::abs(error));
    }
  }
}

void JointRows::finish(double dt_s) {
  for (const JointRow& row : rows) {
    row.joint->internalSetAppliedImpulse(toBt(row.impulse_Ns));
    if (btJointFeedback* feedback = row.joint->getJointFeedback()) addFeedback(*feedback, row, dt_s);
    if (std::abs(row.impulse_Ns) >= row.joint->getBreakingImpulseThreshold()) row.joint->setEnabled(false);
  }
}

}  // namespace vps::bullet
