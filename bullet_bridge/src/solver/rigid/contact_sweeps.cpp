// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid/contact_sweeps.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <algorithm>
#include <cmath>

#include "solver/contact_key.h"
#include "vps/contact_tolerances.h"
#include "vps/friction.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

// Limits the restitution to 0..1, since more than 1 would add energy. Bullet accepts any value, even NaN.
double restitutionOf(const btManifoldPoint& point) {
  const double e = point.m_combinedRestitution;
  return e > 0 ? std::min(e, 1.0) : 0.0;
}

Vec3 middle_W(const btManifoldPoint& point) {
  return 0.5 * fromBt(point.getPositionWorldOnA() + point.getPositionWorldOnB());
}

}  // namespace

Vec3 RigidContact::position_W() const {
  return middle_W(*point);
}
Vec3 RigidContact::normal_W() const {
  return fromBt(point->m_normalWorldOnB);
}
Vec3 RigidContact::tangent_W(int k) const {
  return fromBt(k == 0 ? point->m_lateralFrictionDir1 : point->m_lateralFrictionDir2);
}

double ContactSweeps::velocity(const ContactRow& row) const {
  return row.velocity([this](std::size_t i) -> const Vec6& { return island_.bodies[i].u; });
}

void ContactSweeps::apply(const ContactRow& row, double impulse) {
  for (const ContactRow::Side& side : row.side)
    if (side.body >= 0) body(side).u += impulse * side.MinvJ;
}

// Returns false if no body of the island is part of the contact.
bool ContactSweeps::makeRows(RigidContact& c) const {
  // Both forces act at the middle of the gap, since opposite forces along one line conserve angular momentum.
  // The levers are doubles: rounding to floats would move the two forces apart.
  const Vec3 at = c.position_W();
  ContactRow* const rows[3] = {&c.normal, &c.tangent[0], &c.tangent[1]};
  const Vec3 directions[3] = {c.normal_W(), c.tangent_W(0), c.tangent_W(1)};
  bool is_any_moved = false;
  for (int i = 0; i < 2; ++i) {
    const Vec3 r = at - fromBt(c.object[i]->getWorldTransform().getOrigin());
    const int body = island_.indexOf(c.object[i]);
    is_any_moved |= body >= 0;
    const Vec6 fixed = body < 0 ? Island::fixedVelocity(c.object[i]) : Vec6(Vec6::Zero());
    for (int k = 0; k < 3; ++k) {
      const Vec3 direction = i == 0 ? directions[k] : Vec3(-directions[k]);
      rows[k]->side[i].body = body;
      rows[k]->side[i].J = stacked(r.cross(direction), direction);
      if (body < 0) rows[k]->fixed_velocity += rows[k]->side[i].J.dot(fixed);
    }
  }
  return is_any_moved;
}

void ContactSweeps::prepareRow(ContactRow& row) const {
  row.W = 0;
  for (ContactRow::Side& side : row.side) {
    if (side.body < 0) continue;
    side.MinvJ = body(side).effective_inverse * side.J;
    row.W += side.J.dot(side.MinvJ);
  }
}

void ContactSweeps::add(btPersistentManifold& manifold, btManifoldPoint& point,
                        const btContactSolverInfo& info) {
  const btCollisionObject* const objects[2] = {manifold.getBody0(), manifold.getBody1()};
  RigidContact c;
  c.point = &point;
  for (int i = 0; i < 2; ++i) c.object[i] = objects[i];
  c.mu = point.m_combinedFriction;
  c.area_m2 = area_m2(point);
  const double distance_m = solvedDistance_m(point);
  c.gap_m = distance_m + info.m_linearSlop - restGap_m(point);
  c.is_sharp = restGap_m(point) > 0 && distance_m > 0;
  if (point.m_normalWorldOnB.isZero()) return;  // a contact without a normal has no direction
  if (!(point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED)) {
    btPlaneSpace1(point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
    point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
  }
  if (!makeRows(c)) return;

  c.restitution = restitutionOf(point);
  if (c.gap_m > 0) c.target_m_s = -c.gap_m / info.m_timeStep;
  if (info.m_solverMode & SOLVER_USE_WARMSTARTING) {
    c.p_n = std::max<double>(0, point.m_appliedImpulse);
    c.p_t[0] = point.m_appliedImpulseLateral1;
    c.p_t[1] = point.m_appliedImpulseLateral2;
  }
  contacts_.push_back(c);
}

void ContactSweeps::addMissed(std::span<const MissedContact> missed, const btContactSolverInfo& info) {
  const double dt_s = info.m_timeStep;
  for (const MissedContact& m : missed) {
    if (!m.point) continue;
    RigidContact c;
    c.point = m.point;
    for (int i = 0; i < 2; ++i) c.object[i] = m.object[i];
    c.mu = m.point->m_combinedFriction;
    c.area_m2 = area_m2(*m.point);
    if (!makeRows(c)) continue;
    const double v = velocity(c.normal);
    const double gap_m = m.end_gap_m - (v + pushVelocity(c.normal)) * dt_s;
    c.gap_m = gap_m - m.rest_m;
    c.is_sharp = m.is_sharp;
    c.target_m_s = -(gap_m - m.kept_m) / dt_s;
    c.restitution = restitutionOf(*m.point);
    const auto same = std::find_if(contacts_.begin(), contacts_.end(),
                                   [&](const RigidContact& had) { return had.point == m.point; });
    if (same == contacts_.end()) {
      contacts_.push_back(c);
      continue;
    }
    // A contact that no surface faces any more (is_let_go) starts from zero, since its old impulse would be a
    // worse start; see start().
    if (!m.is_let_go) {
      c.p_n = same->p_n;
      c.p_t[0] = same->p_t[0];
      c.p_t[1] = same->p_t[1];
    }
    *same = c;
  }
}

void ContactSweeps::prepare() {
  joint_states_.clear();
  for (JointRow& row : joints_.rows) {
    JointState joint{&row, {Vec6::Zero(), Vec6::Zero()}, 0};
    joint.W = row.inverseMass(island_, &joint.MinvJ);
    row.impulse_Ns = 0;
    if (joint.W > 0) joint_states_.push_back(joint);
  }
  for (RigidContact& c : contacts_) {
    prepareRow(c.normal);
    prepareRow(c.tangent[0]);
    prepareRow(c.tangent[1]);
    double w12 = 0;
    for (int i = 0; i < 2; ++i)
      if (c.tangent[0].side[i].body >= 0) w12 += c.tangent[0].side[i].J.dot(c.tangent[1].side[i].MinvJ);
    const double w11 = c.tangent[0].W, w22 = c.tangent[1].W, det = w11 * w22 - w12 * w12;
    c.W_t = 0.5 * (w11 + w22) + std::hypot(0.5 * (w11 - w22), w12);
    c.W_t_inverse[0] = w22 / det;
    c.W_t_inverse[1] = -w12 / det;
    c.W_t_inverse[2] = w11 / det;
  }
}

// Last step's impulses p are a good start if they lower the function that the solution minimises, p A p / 2 +
// p (v - target), where A p is the change of velocity that they cause. Otherwise the sweeps start from zero:
// in parts that start inside each other contacts contradict each other, and balanced impulses would grow from
// step to step with every contact that comes or goes.
void ContactSweeps::start() {
  prepare();
  setFreeVelocities();
  const auto work = [&] {
    double sum = 0;
    for (const RigidContact& c : contacts_) {
      if (c.p_n != 0) sum += c.p_n * (0.5 * velocity(c.normal) - 0.5 * c.target_m_s);
      for (int t = 0; t < 2; ++t)
        if (c.p_t[t] != 0) sum += c.p_t[t] * 0.5 * velocity(c.tangent[t]);
    }
    return sum;
  };
  const double before = work();
  applyImpulses();
  if (before + work() <= 0) return;
  for (RigidContact& c : contacts_) c.p_n = c.p_t[0] = c.p_t[1] = 0;
  applyImpulses();
}

void ContactSweeps::setFreeVelocities() {
  for (IslandBody& b : island_.bodies) b.u = b.effective_inverse * (b.momentum + b.coupling_impulse);
}

void ContactSweeps::applyImpulses() {
  setFreeVelocities();
  for (const RigidContact& c : contacts_) {
    if (c.p_n != 0) apply(c.normal, c.p_n);
    for (int t = 0; t < 2; ++t)
      if (c.p_t[t] != 0) apply(c.tangent[t], c.p_t[t]);
  }
  for (const JointState& joint : joint_states_)
    for (int i = 0; i < 2; ++i)
      if (joint.row->body[i] >= 0)
        island_.bodies[static_cast<std::size_t>(joint.row->body[i])].u +=
            joint.row->impulse_Ns * joint.MinvJ[i];
}

// In the residual, an angular velocity of a joint counts as the velocity at a radius of 10 mm (assumed).
double ContactSweeps::sweepJoints() {
  double residual_m_s = 0;
  for (const JointState& joint : joint_states_) {
    JointRow& row = *joint.row;
    const double error = row.target - row.velocity(island_) - row.cfm * joint.W * row.impulse_Ns;
    const double wanted_Ns = row.impulse_Ns + error / (joint.W * (1 + row.cfm));
    const double change_Ns = std::clamp(wanted_Ns, row.lower_Ns, row.upper_Ns) - row.impulse_Ns;
    if (change_Ns == 0) continue;
    row.impulse_Ns += change_Ns;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0)
        island_.bodies[static_cast<std::size_t>(row.body[i])].u += change_Ns * joint.MinvJ[i];
    const bool is_turn = row.J[0].tail<3>().isZero(0) && row.J[1].tail<3>().isZero(0);
    residual_m_s = std::max(residual_m_s, std::abs(change_Ns) * joint.W * (is_turn ? 0.01 : 1));
  }
  return residual_m_s;
}

// Returns the greatest change of a row's velocity.
double ContactSweeps::sweepOnce() {
  double residual_m_s = sweepJoints();
  for (RigidContact& c : contacts_) {
    const double p_n = std::max(0.0, c.p_n + (c.target_m_s - velocity(c.normal)) / c.normal.W);
    if (p_n != c.p_n) {
      apply(c.normal, p_n - c.p_n);
      residual_m_s = std::max(residual_m_s, std::abs(p_n - c.p_n) * c.normal.W);
      c.p_n = p_n;
    }
    if (p_n == 0 && c.p_t[0] == 0 && c.p_t[1] == 0) continue;
    const double v1 = velocity(c.tangent[0]), v2 = velocity(c.tangent[1]);
    const double limit = c.mu * p_n;
    double p1 = c.p_t[0] - (c.W_t_inverse[0] * v1 + c.W_t_inverse[1] * v2);
    double p2 = c.p_t[1] - (c.W_t_inverse[1] * v1 + c.W_t_inverse[2] * v2);
    if (tangentLength(p1, p2) > limit) {
      // The contact slides. The change must be along the slip: a change by the block's inverse, scaled back,
      // would converge to friction along W^-1 v instead of along the slip, 1 % too weak.
      p1 = c.p_t[0] - v1 / c.W_t;
      p2 = c.p_t[1] - v2 / c.W_t;
      limitToCone(p1, p2, limit);
    }
    const double d1 = p1 - c.p_t[0], d2 = p2 - c.p_t[1];
    if (d1 != 0) apply(c.tangent[0], d1);
    if (d2 != 0) apply(c.tangent[1], d2);
    c.p_t[0] = p1;
    c.p_t[1] = p2;
    residual_m_s =
        std::max(residual_m_s, std::max(std::abs(d1) * c.tangent[0].W, std::abs(d2) * c.tangent[1].W));
  }
  return residual_m_s;
}

SolveOutcome ContactSweeps::sweep(double residual_m_s, int limit) {
  SolveOutcome outcome;
  while (outcome.steps < limit && !outcome.is_converged) {
    outcome.is_converged = sweepOnce() <= residual_m_s;
    ++outcome.steps;
  }
  return outcome;
}

void ContactSweeps::finish() const {
  for (const RigidContact& c : contacts_) {
    c.point->m_appliedImpulse = toBt(c.p_n);
    c.point->m_appliedImpulseLateral1 = toBt(c.p_t[0]);
    c.point->m_appliedImpulseLateral2 = toBt(c.p_t[1]);
  }
}

}  // namespace vps::bullet
