// SPDX-License-Identifier: BSD-3-Clause
// The push: moves overlapping bodies apart without leaving a velocity.
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/rigid/contact_sweeps.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

double ContactSweeps::pushVelocity(const ContactRow& row) const {
  double v = 0;
  if (push_.empty()) return v;
  for (const ContactRow::Side& side : row.side)
    if (side.body >= 0) v += side.J.dot(push_[static_cast<std::size_t>(side.body)]);
  return v;
}

// A joint resists the push; a motor or limit, whose impulse is bounded, does not.
void ContactSweeps::pushJoint(const JointState& joint) {
  const JointRow& row = *joint.row;
  if (row.isBounded()) return;
  const double impulse_Ns = (row.fixed_velocity - row.velocity(island_)) / joint.W;
  for (int i = 0; i < 2; ++i)
    if (row.body[i] >= 0)
      island_.bodies[static_cast<std::size_t>(row.body[i])].u += impulse_Ns * joint.MinvJ[i];
}

void ContactSweeps::solvePush(const btContactSolverInfo& info, int sweep_limit) {
  const double dt = info.m_timeStep;
  bool is_needed = false;
  for (RigidContact& c : contacts_) {
    const double left_m = c.gap_m + velocity(c.normal) * dt;
    is_needed |= left_m < -kRounding_m;
    c.push_m_s = left_m < 0 ? std::min(-info.m_erp2 * left_m / dt, kSeparation_m_s) : -left_m / dt;
    c.p_push = 0;
  }
  push_.clear();
  if (!is_needed) return;
  push_.assign(island_.bodies.size(), Vec6::Zero());
  for (std::size_t i = 0; i < push_.size(); ++i) std::swap(island_.bodies[i].u, push_[i]);
  for (int i = 0; i < sweep_limit; ++i) {
    double residual_m_s = 0;
    for (const JointState& joint : joint_states_) pushJoint(joint);
    for (RigidContact& c : contacts_) {
      double v = 0;  // the motion of kinematic bodies does not belong to the push
      for (const ContactRow::Side& side : c.normal.side)
        if (side.body >= 0) v += side.J.dot(body(side).u);
      // The overlaps to be removed may contradict each other, as for a jammed part, so they are removed
      // softly. Gaps of sharp features are a hard limit: no other row's push may reduce them.
      const double W = c.normal.W;
      double p = c.push_m_s <= 0 || c.is_sharp ? c.p_push + (std::min(0.0, c.push_m_s) - v) / W : 0;
      if (c.push_m_s > 0)
        p = std::max(p,
                     c.p_push + (c.push_m_s - v - kPushSoftness * W * c.p_push) / ((1 + kPushSoftness) * W));
      p = std::max(0.0, p);
      if (p == c.p_push) continue;
      apply(c.normal, p - c.p_push);
      residual_m_s = std::max(residual_m_s, std::abs(p - c.p_push) * c.normal.W);
      c.p_push = p;
    }
    // With ten times this tolerance a heavy load on light bodies sank in each step as much as each push
    // raised it.
    if (residual_m_s * dt < kRounding_m) break;
  }
  for (std::size_t i = 0; i < push_.size(); ++i) {
    IslandBody& b = island_.bodies[i];
    Vec6& push = push_[i];
    std::swap(b.u, push);
    // The push of each row is limited, but contradictory rows may add up.
    const double fastest_m_s = push.tail<3>().norm() + push.head<3>().norm() * b.reach_m;
    if (fastest_m_s > kSeparation_m_s) push *= kSeparation_m_s / fastest_m_s;
  }
}

}  // namespace vps::bullet
