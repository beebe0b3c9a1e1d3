// SPDX-License-Identifier: BSD-3-Clause
#include "solver/impact/restitution.h"

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "solver/contact_key.h"
#include "vps/contact_tolerances.h"
#include "vps/friction.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

// Bounds of a joint's row in an impact. Returns false for rows with a bounded impulse (motors), which take no
// part.
bool boundsOf(const JointRow& row, double& lower_Ns, double& upper_Ns) {
  const auto isBound = [](double limit_Ns) {
    return limit_Ns == 0 || std::abs(limit_Ns) >= JointRow::kAny_Ns;
  };
  if (!isBound(row.lower_Ns) || !isBound(row.upper_Ns)) return false;
  lower_Ns = row.lower_Ns == 0 ? 0 : -std::numeric_limits<double>::infinity();
  upper_Ns = row.upper_Ns == 0 ? 0 : std::numeric_limits<double>::infinity();
  return lower_Ns < upper_Ns;
}

// True if the contact's bodies touch at the end of the step.
bool touchesAtEnd(const RigidContact& c, double touch_m, double velocity_m_s, double dt_s) {
  return c.p_n > 0 || std::min(velocity_m_s - c.target_m_s, velocity_m_s + c.gap_m / dt_s) * dt_s <= touch_m;
}

}  // namespace

bool Restitution::isImpact(const RigidContact& c, double threshold_m_s) const {
  if (!(c.restitution > 0) || !(c.p_n > 0)) return false;
  return c.normal.velocity([&](std::size_t i) -> const Vec6& { return island_.bodies[i].start; }) <
         -threshold_m_s;
}

int Restitution::rootOf(int body) const {
  while (parent_[static_cast<std::size_t>(body)] != body) body = parent_[static_cast<std::size_t>(body)];
  return body;
}

// Finds the gap at which each contact counts as touching. Sharp features rest at a gap and hold the faces
// between them at that gap, so all contacts of a face within this gap touch. If only the contacts of a face's
// edges touched, a face that lands flush would turn, since the contacts of one edge may be missing.
void Restitution::findTouch(std::span<const RigidContact> contacts) {
  std::map<std::pair<const btCollisionObject*, const btCollisionObject*>, double> rest_m;
  const auto restOf_m = [&](const RigidContact& c) -> double& { return rest_m[{c.object[0], c.object[1]}]; };
  for (const RigidContact& c : contacts) restOf_m(c) = std::max(restOf_m(c), restGap_m(*c.point));
  touch_m_.clear();
  for (const RigidContact& c : contacts)
    touch_m_.push_back(kSameGap_m + std::max(restOf_m(c) - restGap_m(*c.point), 0.0));
}

void Restitution::connect(std::span<RigidContact> contacts, const StepSolution& solution, double dt_s) {
  parent_.resize(island_.bodies.size());
  std::iota(parent_.begin(), parent_.end(), 0);
  const auto join = [&](int a, int b) {
    if (a < 0 || b < 0) return;
    const int root_a = rootOf(a), root_b = rootOf(b);
    parent_[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
  };
  findTouch(contacts);
  touches_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const RigidContact& c = contacts[k];
    const double v = c.normal.velocity([&](std::size_t i) -> const Vec6& { return solution.u[i]; });
    touches_.push_back(touchesAtEnd(c, touch_m_[k], v, dt_s));
    if (touches_.back()) join(c.normal.side[0].body, c.normal.side[1].body);
  }
  for (const JointRow& row : joints_.rows) {
    double lower = 0, upper = 0;
    if (boundsOf(row, lower, upper)) join(row.body[0], row.body[1]);
  }
}

// Place at which a contact acts at the end of the step. The place moves with the body that turns more
// easily. In a shortened step it moves with the heavier body, since a light body between others may be
// anywhere.
Vec3 Restitution::placeOf(const RigidContact& c, const StepSolution& solution,
                          std::span<const BodyEnd> ends) const {
  const Vec3 x_W = c.position_W();
  Vec3 way_W = Vec3::Zero();
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    const int body = c.normal.side[i].body;
    if (body < 0) continue;
    const BodyEnd& end = ends[static_cast<std::size_t>(body)];
    const Pose X_WB = fromBt(c.object[i]->getWorldTransform());
    const double ease =
        solution.is_cut_short ? end.mass(3, 3) : end.inverse_mass.topLeftCorner<3, 3>().trace();
    way_W += ease * (end.X_WB * (X_WB.inverse() * x_W) - x_W);
    sum += ease;
  }
  return sum > 0 ? Vec3(x_W + way_W / sum) : x_W;
}

ImpactRow Restitution::rowOf(const ContactRow& row, const Vec3& at_W, const Vec3& d_W,
                             std::span<const BodyEnd> ends) const {
  ImpactRow to;
  to.fixed_velocity = row.fixed_velocity;
  for (int i = 0; i < 2; ++i) {
    const int body = row.side[i].body;
    if (body < 0) continue;
    const Vec3 d = i == 0 ? d_W : Vec3(-d_W);
    to.body[i] = local_[static_cast<std::size_t>(body)];
    to.J[i] = stacked((at_W - ends[static_cast<std::size_t>(body)].X_WB.p).cross(d), d);
  }
  to.prepare(group_.inverse_mass);
  return to;
}

void Restitution::gather(int root, std::span<RigidContact> contacts, const StepSolution& solution,
                         std::span<const BodyEnd> ends) {
  group_ = {};
  local_.assign(island_.bodies.size(), -1);
  for (std::size_t i = 0; i < island_.bodies.size(); ++i) {
    if (rootOf(static_cast<int>(i)) != root) continue;
    local_[i] = static_cast<int>(group_.bodies.size());
    group_.bodies.push_back(static_cast<int>(i));
    group_.inverse_mass.push_back(ends[i].inverse_mass);
    group_.solved.push_back(ends[i].v);
  }
  const auto isOfGroup = [&](int a, int b) {
    const int body = std::max(a, b);
    return body >= 0 && local_[static_cast<std::size_t>(body)] >= 0;
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    RigidContact& c = contacts[k];
    if (!touches_[k] || !isOfGroup(c.normal.side[0].body, c.normal.side[1].body)) continue;
    const Vec3 at_W = placeOf(c, solution, ends);
    Contact contact{&c, {}, {c.p_t[0], c.p_t[1]}, 0, touch_m_[k]};
    for (int t = 0; t < 2; ++t) contact.tangent[t] = rowOf(c.tangent[t], at_W, c.tangent_W(t), ends);
    contact.W_t = contact.tangent[0].W + contact.tangent[1].W;
    group_.contacts.push_back(contact);
    group_.rows.push_back(rowOf(c.normal, at_W, c.normal_W(), ends));
    group_.rows.back().restitution = c.restitution;
    group_.solved_Ns.push_back(c.p_n);
  }
  for (JointRow& joint : joints_.rows) {
    ImpactRow row;
    if (!isOfGroup(joint.body[0], joint.body[1]) || !boundsOf(joint, row.lower_Ns, row.upper_Ns)) continue;
    row.fixed_velocity = joint.fixed_velocity - joint.target;
    for (int i = 0; i < 2; ++i) {
      row.J[i] = joint.J[i];
      if (joint.body[i] >= 0) row.body[i] = local_[static_cast<std::size_t>(joint.body[i])];
    }
    row.prepare(group_.inverse_mass);
    group_.joints.push_back(&joint);
    group_.rows.push_back(row);
    group_.solved_Ns.push_back(joint.impulse_Ns);
  }
}

// Finds the change of momentum in the step without the impulses of contacts and joints, which acted at the
// poses before the step.
void Restitution::takeExternal(const StepSolution& solution) {
  for (const int i : group_.bodies) {
    const IslandBody& body = island_.bodies[static_cast<std::size_t>(i)];
    group_.impulse.push_back(solution.momenta[static_cast<std::size_t>(i)] - body.mass * body.start);
  }
  std::vector<Vec6> external = group_.impulse;
  const auto take = [&](int body, const Vec6& J, double impulse_Ns) {
    if (body >= 0)
      external[static_cast<std::size_t>(local_[static_cast<std::size_t>(body)])] -= impulse_Ns * J;
  };
  for (const Contact& c : group_.contacts)
    for (int i = 0; i < 2; ++i) {
      take(c.of->normal.side[i].body, c.of->normal.side[i].J, c.of->p_n);
      for (int t = 0; t < 2; ++t)
        take(c.of->tangent[t].side[i].body, c.of->tangent[t].side[i].J, c.of->p_t[t]);
    }
  for (const JointRow* joint : group_.joints)
    for (int i = 0; i < 2; ++i) take(joint->body[i], joint->J[i], joint->impulse_Ns);
  for (std::size_t i = 0; i < external.size(); ++i) {
    const IslandBody& body = island_.bodies[static_cast<std::size_t>(group_.bodies[i])];
    group_.external.push_back(group_.inverse_mass[i] * external[i]);
    group_.kick.push_back(group_.inverse_mass[i] * body.external_Ns);
  }
}

void Restitution::settleFriction(Contact& c, double limit_Ns, double& most_m_s) {
  if (!(c.W_t > 0)) return;
  double p[2];
  for (int t = 0; t < 2; ++t) p[t] = c.p_t[t] - c.tangent[t].velocity(group_.v) / c.W_t;
  limitToCone(p[0], p[1], limit_Ns);
  for (int t = 0; t < 2; ++t) {
    const double change_Ns = p[t] - c.p_t[t];
    if (change_Ns != 0) c.tangent[t].apply(change_Ns, group_.v);
    most_m_s = std::max(most_m_s, std::abs(change_Ns) * c.W_t);
    c.p_t[t] = p[t];
  }
}

void Restitution::settle() {
  Group& g = group_;
  // The impact is first solved without friction, which is exact also for flush faces with dozens of contacts.
  std::vector<double> p;
  ImpactProjection(g.rows).solve(std::vector<std::uint8_t>(g.rows.size(), 1), kRoundingSpeed_m_s, g.v, p);
  const auto limitOf_Ns = [&](std::size_t k) {
    return g.contacts[k].of->mu * std::max(p[k] + g.bounced_Ns[k], 0.0);
  };
  for (std::size_t k = 0; k < g.contacts.size(); ++k) {
    Contact& c = g.contacts[k];
    limitToCone(c.p_t[0], c.p_t[1], limitOf_Ns(k));
    for (int t = 0; t < 2; ++t) c.tangent[t].apply(c.p_t[t], g.v);
  }
  for (int sweep = 0; sweep < kMostImpactSweeps; ++sweep) {
    double most_m_s = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      const ImpactRow& row = g.rows[k];
      if (row.W > 0) {
        const double to_Ns = std::clamp(p[k] - row.velocity(g.v) / row.W, row.lower_Ns, row.upper_Ns);
        if (to_Ns != p[k]) row.apply(to_Ns - p[k], g.v);
        most_m_s = std::max(most_m_s, std::abs(to_Ns - p[k]) * row.W);
        p[k] = to_Ns;
      }
      if (k < g.contacts.size()) settleFriction(g.contacts[k], limitOf_Ns(k), most_m_s);
    }
    if (!(most_m_s > kRoundingSpeed_m_s)) break;
  }
  g.p_Ns = g.bounced_Ns;
  for (std::size_t k = 0; k < p.size(); ++k) g.p_Ns[k] += p[k];
}

void Restitution::write(double share, std::span<BodyEnd> ends) {
  Group& g = group_;
  const auto part = [share](double from, double to) { return share < 1 ? from + share * (to - from) : to; };
  for (std::size_t i = 0; i < g.bodies.size(); ++i)
    ends[static_cast<std::size_t>(g.bodies[i])].v =
        share < 1 ? Vec6(g.solved[i] + share * (g.v[i] - g.solved[i])) : g.v[i];
  for (std::size_t k = 0; k < g.contacts.size(); ++k) {
    RigidContact& c = *g.contacts[k].of;
    c.p_n = std::max(part(c.p_n, g.p_Ns[k]), 0.0);
    for (int t = 0; t < 2; ++t) c.p_t[t] = part(c.p_t[t], g.contacts[k].p_t[t]);
  }
  for (std::size_t k = 0; k < g.joints.size(); ++k) {
    double& impulse_Ns = g.joints[k]->impulse_Ns;
    impulse_Ns = part(impulse_Ns, g.p_Ns[g.contacts.size() + k]);
  }
}

void Restitution::apply(std::span<RigidContact> contacts, const StepSolution& solution,
                        std::span<BodyEnd> ends, const btContactSolverInfo& info) {
  std::vector<int> roots;
  for (const RigidContact& c : contacts) {
    if (!isImpact(c, info.m_restitutionVelocityThreshold)) continue;
    if (roots.empty()) connect(contacts, solution, info.m_timeStep);
    const int root = rootOf(std::max(c.normal.side[0].body, c.normal.side[1].body));
    if (std::find(roots.begin(), roots.end(), root) == roots.end()) roots.push_back(root);
  }
  for (const int root : roots) {
    gather(root, contacts, solution, ends);
    takeExternal(solution);
    bounce(ends, info.m_timeStep);
    settle();
    if (const double share = shareWithoutGain(ends); share > 0) write(share, ends);
  }
}

}  // namespace vps::bullet
