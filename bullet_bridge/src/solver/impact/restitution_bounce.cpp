// SPDX-License-Identifier: BSD-3-Clause
// The bounce of a group: its time, the velocities before and after it, and the limit of its energy.
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/impact/restitution.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

// The velocities before the step, referred to the end pose. The solution's impulses acted along lines at the
// start poses, so the displacement changed the group's angular momentum. The angular momentum that the group
// lost by this displacement is given back as a rotation of the whole group. Given back to each body alone, it
// would spin a light body between heavy ones without bound: the error is 1 um times the impulse of bodies
// with 1e5 times its inertia.
std::vector<Vec6> Restitution::beforeStep(std::span<const BodyEnd> ends, double dt_s) const {
  std::vector<BodyEnd> group_ends;
  std::vector<Vec6> lost(group_.bodies.size(), Vec6::Zero());
  for (const int i : group_.bodies) {
    const IslandBody& body = island_.bodies[static_cast<std::size_t>(i)];
    group_ends.push_back(ends[static_cast<std::size_t>(i)]);
    BodyEnd& end = group_ends.back();
    end.v = body.turns_freely ? Vec6(end.inverse_mass * (body.mass * body.start)) : body.start;
  }
  const auto add = [&](const ContactRow& at_start, const ImpactRow& at_end, double impulse_Ns) {
    if (at_end.body[0] < 0 || at_end.body[1] < 0) return;
    for (int i = 0; i < 2; ++i)
      lost[static_cast<std::size_t>(at_end.body[i])] += impulse_Ns * (at_start.side[i].J - at_end.J[i]);
  };
  for (std::size_t k = 0; k < group_.contacts.size(); ++k) {
    const Contact& c = group_.contacts[k];
    add(c.of->normal, group_.rows[k], c.of->p_n);
    for (int t = 0; t < 2; ++t) add(c.of->tangent[t], c.tangent[t], c.of->p_t[t]);
  }
  const bool is_free = std::all_of(group_.rows.begin(), group_.rows.end(),
                                   [](const ImpactRow& row) { return row.body[0] >= 0 && row.body[1] >= 0; });
  // The push moves bodies without momentum, but changes the lever arms of their linear momenta.
  for (std::size_t i = 0; is_free && i < group_ends.size(); ++i) {
    const IslandBody& body = island_.bodies[static_cast<std::size_t>(group_.bodies[i])];
    const Vec3 pushed_W =
        group_ends[i].X_WB.p - fromBt(body.rigid->getWorldTransform()).p - dt_s * body.u.tail<3>();
    lost[i].head<3>() -= pushed_W.cross(body.mass(3, 3) * group_.solved[i].tail<3>());
  }
  addTurn(commonTurn(lost, group_ends), group_ends);
  std::vector<Vec6> before;
  for (const BodyEnd& end : group_ends) before.push_back(end.v);
  return before;
}

// Time of the group's impact, as a share of the step: the mean over its contacts, weighted by impulse and
// approach.
double Restitution::shareOfImpact(const std::vector<Vec6>& before, double dt_s) const {
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < group_.contacts.size(); ++k) {
    const RigidContact& c = *group_.contacts[k].of;
    if (!(c.restitution > 0) || !(c.p_n > 0)) continue;
    const double kick_m_s = kickAlong(k), approach_m_s = -group_.rows[k].velocity(before) - 0.5 * kick_m_s;
    if (!(approach_m_s > 0)) continue;
    // gap = approach t + kick t^2 / (2 dt)
    const double gap_m_s = std::max(c.gap_m, 0.0) / dt_s;
    const double root = approach_m_s * approach_m_s - 2 * kick_m_s * gap_m_s;
    const double share = 2 * gap_m_s / (approach_m_s + std::sqrt(std::max(root, 0.0)));
    sum += c.p_n * approach_m_s * std::clamp(share, 0.0, 1.0);
    weight += c.p_n * approach_m_s;
  }
  return weight > 0 ? sum / weight : 0;
}

// Marks the rows that hold bodies before the impact: joints, and touching contacts that approach by the kick
// only.
std::vector<std::uint8_t> Restitution::holding(const std::vector<Vec6>& before, double dt_s) const {
  std::vector<std::uint8_t> rows(group_.rows.size(), 1);
  for (std::size_t k = 0; k < group_.contacts.size(); ++k) {
    // `before` contains at most 3/2 of the kick; twice the kick is above that.
    const double kick_m_s = 2 * std::abs(kickAlong(k));
    rows[k] = group_.rows[k].velocity(before) >= -kick_m_s &&
              group_.contacts[k].of->gap_m <= group_.contacts[k].touch_m + kick_m_s * dt_s;
  }
  return rows;
}

double Restitution::kickAlong(std::size_t row) const {
  return group_.rows[row].velocity(group_.kick) - group_.rows[row].fixed_velocity;
}

// The part of the kick that acts after the impact, without the share that would change the velocities of
// contacts that were hit. The contacts' impulses for this correction are added to the impulses of the bounce.
std::vector<Vec6> Restitution::restOfKick(double share) {
  std::vector<Vec6> rest = group_.kick;
  for (Vec6& v : rest) v *= 1 - share;
  std::vector<ImpactRow> rows = group_.rows;
  std::vector<std::uint8_t> chosen(rows.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    chosen[k] = group_.bounced_Ns[k] != 0;
    rows[k].fixed_velocity = 0;
    rows[k].lower_Ns = -std::numeric_limits<double>::infinity();
    rows[k].upper_Ns = std::numeric_limits<double>::infinity();
  }
  std::vector<double> held_Ns;
  ImpactProjection(rows).solve(chosen, kRoundingSpeed_m_s, rest, held_Ns);
  for (std::size_t k = 0; k < rows.size(); ++k) group_.bounced_Ns[k] += held_Ns[k];
  return rest;
}

// Sets the velocities after the bounce and with all external impulses, before contacts settle.
void Restitution::bounce(std::span<const BodyEnd> ends, double dt_s) {
  const std::vector<Vec6> start = beforeStep(ends, dt_s);
  const bool has_kick =
      std::any_of(group_.kick.begin(), group_.kick.end(), [](const Vec6& kick) { return !kick.isZero(0); });
  const double share = has_kick ? shareOfImpact(start, dt_s) : 0;
  std::vector<Vec6> before = start;
  if (has_kick) {
    for (std::size_t i = 0; i < before.size(); ++i) before[i] += (0.5 + share) * group_.kick[i];
    std::vector<double> held_Ns;
    ImpactProjection(group_.rows).solve(holding(start, dt_s), kRoundingSpeed_m_s, before, held_Ns);
  }
  ImpactState after = afterImpact(group_.rows, before);
  group_.bounced_Ns = std::move(after.p_Ns);
  std::vector<Vec6> rest(before.size(), Vec6::Zero());
  if (has_kick) rest = restOfKick(share);
  group_.v = start;
  for (std::size_t i = 0; i < before.size(); ++i)
    group_.v[i] += (after.v[i] - before[i]) + (group_.external[i] - (1 - share) * group_.kick[i]) + rest[i];
}

// Greatest share s of the change of velocities for which the excess of energy, a s^2 + b s + c, is not
// positive; or the s with the least excess.
double Restitution::shareWithoutGain(std::span<const BodyEnd> ends) const {
  const Group& g = group_;
  double a = 0, b = 0, c = 0, scale_J = 0;
  for (std::size_t i = 0; i < g.bodies.size(); ++i) {
    const auto at = static_cast<std::size_t>(g.bodies[i]);
    const IslandBody& body = island_.bodies[at];
    const Vec6 change = g.v[i] - g.solved[i], momentum = ends[at].mass * change;
    // Bullet's stored velocities plus half a kick: a step keeps the energy of these velocities.
    const Vec6 start = body.start + 0.5 * body.mass.llt().solve(body.external_Ns),
               solved = g.solved[i] + 0.5 * g.kick[i];
    const double before_J = 0.5 * start.dot(body.mass * start);
    a += 0.5 * momentum.dot(change);
    b += momentum.dot(solved);
    c += 0.5 * solved.dot(ends[at].mass * solved) - before_J - g.impulse[i].dot(body.u);
    scale_J += before_J;
  }
  // Contacts may do work only against bodies that they do not move.
  const auto twistOf = [&](std::size_t i) -> const Vec6& { return island_.bodies[i].u; };
  for (std::size_t k = 0; k < g.rows.size(); ++k)
    b += g.rows[k].fixed_velocity * (g.p_Ns[k] - g.solved_Ns[k]);
  for (const Contact& contact : g.contacts) {
    const RigidContact& of = *contact.of;
    c += of.p_n * of.normal.velocity(twistOf);
    for (int t = 0; t < 2; ++t) {
      c += of.p_t[t] * of.tangent[t].velocity(twistOf);
      b += of.tangent[t].fixed_velocity * (contact.p_t[t] - of.p_t[t]);
    }
  }
  if (a + b + c <= kSumRounding * scale_J) return 1;
  if (!(a > 0)) return 0;  // also if a value is not finite
  // A solution that has not converged may exceed the allowed energy by itself; the share with the least
  // energy is then taken.
  const double root = std::max(b * b - 4 * a * c, 0.0);
  return std::clamp((-b + std::sqrt(root)) / (2 * a), 0.0, 1.0);
}

}  // namespace vps::bullet
