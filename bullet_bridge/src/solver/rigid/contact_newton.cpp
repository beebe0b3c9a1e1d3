// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid/contact_newton.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/island/newton_math.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

void ContactNewton::addPatch(const RigidContact& first) {
  Patch& patch = patches_.emplace_back();
  patch.first = patch.end = points_.size();
  patch.center = first.position_W();
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject* object = first.object[i];
    patch.body[i] = first.normal.side[i].body;
    const double sign = i == 0 ? 1 : -1;
    patch.X[i] = sign * twistShift(fromBt(object->getWorldTransform().getOrigin()), patch.center);
    if (patch.body[i] < 0) patch.fixed += patch.X[i] * Island::fixedVelocity(object);
  }
}

void ContactNewton::gather(std::span<const RigidContact> contacts) {
  points_.clear();
  patches_.clear();
  const RigidContact* last = nullptr;
  for (const RigidContact& c : contacts) {
    if (!last || !std::equal(c.object, c.object + 2, last->object)) addPatch(c);
    last = &c;
    Point p;
    p.r = c.position_W() - patches_.back().center;
    p.n = c.normal_W();
    p.mu = c.mu;
    p.W = (c.normal.W + c.tangent[0].W + c.tangent[1].W) / 3;
    p.softness = 0;
    p.target = c.target_m_s;
    p.slip = 0;
    p.impulse = c.p_n * p.n + c.p_t[0] * c.tangent_W(0) + c.p_t[1] * c.tangent_W(1);
    p.next = p.impulse;
    points_.push_back(p);
    patches_.back().end = points_.size();
  }
  joint_states_.clear();
  for (JointRow& row : joints_.rows) {
    const double W = row.inverseMass(island_);
    if (W > 0) joint_states_.push_back({&row, W * std::max(row.cfm, 1 / kRigidRatio), 0, true});
  }
}

void ContactNewton::setCompliance(double compliance) {
  for (Point& p : points_) p.softness = compliance * p.W;
}

Vec6 ContactNewton::twistOf(const Patch& patch, const std::vector<Vec6>& u) const {
  Vec6 twist = patch.fixed;
  for (int i = 0; i < 2; ++i)
    if (patch.body[i] >= 0) twist += patch.X[i] * u[static_cast<std::size_t>(patch.body[i])];
  return twist;
}

namespace {

// Adds factor times the wrench of a force a at r, times that of c transposed.
void addProduct(Mat6& sum, double factor, const Vec3& r, const Vec3& a, const Vec3& c) {
  const Vec6 row = wrenchOf(r, c), column = factor * wrenchOf(r, a);
  for (int k = 0; k < 6; ++k) sum.col(k) += row[k] * column;
}

}  // namespace

// Sets the impulse at a relative velocity: the projection onto the friction cone.
void ContactNewton::project(Point& p, const Vec3& v, Slips slips, Stiffness* stiffness) {
  const double k = 1 / p.softness;
  const Vec3 v_t = v - p.n.dot(v) * p.n;
  const double speed = v_t.norm();
  if (slips == Slips::Follow) p.slip = p.mu * speed;
  const Vec3 y = p.impulse + k * ((p.target - p.slip) * p.n - v);
  const double y_n = p.n.dot(y);
  const Vec3 y_t = y - y_n * p.n;
  const double length = y_t.norm();
  // Derivative of the slip by the velocity.
  const Vec3 slip_v = slips == Slips::Follow && speed > 0 ? Vec3(p.mu / speed * v_t) : Vec3(Vec3::Zero());
  if (y_n > 0 && length <= p.mu * y_n) {  // sticks
    p.next = y;
    if (!stiffness) return;
    stiffness->springs.addEven(k, p.r);
    if (speed > 0) addProduct(stiffness->rest, k, p.r, p.n, slip_v);
    return;
  }
  const double along = y_n + p.mu * length;
  if (!(along > 0)) {  // apart
    p.next.setZero();
    return;
  }
  const double share = 1 / (1 + p.mu * p.mu), p_n = share * along;
  const Vec3 t = length > 0 ? Vec3(y_t / length) : Vec3(Vec3::Zero()), edge = p.n + p.mu * t;
  p.next = p_n * edge;
  if (!stiffness) return;
  addProduct(stiffness->rest, k * share, p.r, edge, edge + slip_v);
  if (p.mu > 0 && length > 0) {
    const Vec3 across = p.n.cross(t);
    addProduct(stiffness->rest, k * p.mu * p_n / length, p.r, across, across);
  }
}

void ContactNewton::evaluateJoints(const std::vector<Vec6>& u, std::vector<Vec6>& missing) {
  for (Joint& joint : joint_states_) {
    const JointRow& row = *joint.row;
    const double v = row.velocity([&](std::size_t i) -> const Vec6& { return u[i]; });
    const double wanted_Ns = (row.target - v) / joint.softness;
    joint.next_Ns = std::clamp(wanted_Ns, row.lower_Ns, row.upper_Ns);
    joint.is_free = joint.next_Ns == wanted_Ns;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0) missing[static_cast<std::size_t>(row.body[i])] -= joint.next_Ns * row.J[i];
  }
}

// Evaluates the missing momentum at u; with_jacobian: also its derivatives.
void ContactNewton::evaluate(const std::vector<Vec6>& u, Slips slips, bool with_jacobian,
                             std::vector<Vec6>& missing) {
  missing.resize(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const IslandBody& b = island_.bodies[i];
    missing[i] = b.effective_mass * u[i] - b.momentum - b.coupling_impulse;
  }
  evaluateJoints(u, missing);
  for (Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u);
    const Vec3 w = twist.head<3>(), v = twist.tail<3>();
    Vec6 wrench = Vec6::Zero();
    Stiffness stiffness;
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      Point& p = points_[i];
      project(p, v + w.cross(p.r), slips, with_jacobian ? &stiffness : nullptr);
      wrench += wrenchOf(p.r, p.next);
    }
    if (with_jacobian) patch.jacobian = stiffness.springs.total() + stiffness.rest;
    for (int i = 0; i < 2; ++i)
      if (patch.body[i] >= 0)
        missing[static_cast<std::size_t>(patch.body[i])] -= patch.X[i].transpose() * wrench;
  }
}

// Computes step_. Returns false if the matrix has no inverse.
bool ContactNewton::findStep() {
  matrix_.setZero();
  for (std::size_t i = 0; i < u_.size(); ++i)
    matrix_.add(static_cast<int>(i), static_cast<int>(i), island_.bodies[i].effective_mass);
  for (const Patch& patch : patches_)
    matrix_.addPair(patch.body, [&](int i, int j) -> Mat6 {
      return patch.X[i].transpose() * patch.jacobian * patch.X[j];
    });
  for (const Joint& joint : joint_states_) {
    const double k = 1 / joint.softness;
    const auto& J = joint.row->J;
    if (joint.is_free)
      matrix_.addPair(joint.row->body, [&](int i, int j) -> Mat6 { return k * J[i] * J[j].transpose(); });
  }
  if (!matrix_.factorise()) return false;
  matrix_.solve(missing_, step_);
  return true;
}

// Squared norm of the missing momentum, in the metric of kinetic energy.
double ContactNewton::sizeOf(const std::vector<Vec6>& missing) {
  double sum = 0;
  for (std::size_t i = 0; i < missing.size(); ++i)
    sum += missing[i].dot(island_.bodies[i].effective_inverse * missing[i]);
  return sum;
}

void ContactNewton::moveTo(double share) {
  trial_.resize(u_.size());
  for (std::size_t i = 0; i < u_.size(); ++i) trial_[i] = u_[i] + share * step_[i];
}

// Takes Newton's step, or a share of it. Returns false if no share reduces the missing momentum. The whole
// step usually reduces the missing momentum, so the derivatives for the next step are computed with it.
bool ContactNewton::step() {
  constexpr double kSufficient = 1e-2;  // required share of the reduction that a linear equation would have
  if (!findStep()) return false;
  const double size = sizeOf(missing_);
  double share = 1;
  for (int k = 0; k < kMostRounds; ++k, share *= 0.5) {
    moveTo(share);
    evaluate(trial_, Slips::Follow, k == 0, trial_missing_);
    if (!(sizeOf(trial_missing_) <= (1 - kSufficient * share) * size)) continue;
    u_.swap(trial_);
    if (k == 0)
      missing_.swap(trial_missing_);
    else
      evaluate(u_, Slips::Follow, true, missing_);
    return true;
  }
  return false;
}

// Takes a step of the convex problem, in which the slip terms are constant. Returns false if the step is not
// a descent direction.
bool ContactNewton::convexStep() {
  evaluate(u_, Slips::Follow, false, missing_);
  evaluate(u_, Slips::Stay, true, missing_);
  if (!findStep()) return false;
  const double slope = sumOfProducts(missing_, step_);
  if (!(slope < 0)) return false;
  const double share = lineSearch(slope, [&](double at) {
    moveTo(at);
    evaluate(trial_, Slips::Stay, false, trial_missing_);
    return sumOfProducts(trial_missing_, step_);
  });
  moveTo(share);
  u_.swap(trial_);
  evaluate(u_, Slips::Follow, true, missing_);
  return true;
}

// The greatest speed that a body would gain from the momentum that the equation still misses.
double ContactNewton::imbalance_m_s() {
  scratch_.resize(u_.size());
  for (std::size_t i = 0; i < u_.size(); ++i) scratch_[i] = island_.bodies[i].effective_inverse * missing_[i];
  return island_.topSpeed(scratch_);
}

SolveOutcome ContactNewton::solveRound(double near_m_s, int step_limit) {
  SolveOutcome outcome;
  evaluate(u_, Slips::Follow, true, missing_);
  for (;;) {
    off_m_s_ = imbalance_m_s();
    outcome.is_converged = off_m_s_ <= near_m_s;
    if (outcome.is_converged || outcome.steps >= step_limit || !std::isfinite(off_m_s_)) return outcome;
    ++outcome.steps;
    if (step()) continue;
    ++outcome.steps;
    if (convexStep()) continue;
    evaluate(u_, Slips::Follow, false, missing_);
    outcome.is_converged = off_m_s_ < near_m_s / kAccuracyShare;  // rounding allows no smaller residual
    return outcome;
  }
}

void ContactNewton::writeImpulses(std::span<RigidContact> contacts) const {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    RigidContact& c = contacts[i];
    const Vec3& impulse = points_[i].impulse;
    const Vec3 &n = points_[i].n, t[2] = {c.tangent_W(0), c.tangent_W(1)};
    c.p_n = n.dot(impulse);
    for (int k = 0; k < 2; ++k) c.p_t[k] = t[k].dot(impulse);
    // In single precision the directions are not exactly orthonormal, and the rest of an impulse would move a
    // light body between heavy ones by a micrometre per second.
    const Vec3 rest = impulse - (c.p_n * n + c.p_t[0] * t[0] + c.p_t[1] * t[1]);
    // The threshold is above the rounding of doubles, so that results in double precision are not changed.
    if (rest.norm() <= kRoundingShare * impulse.norm()) continue;
    c.p_n += n.dot(rest);
    for (int k = 0; k < 2; ++k) c.p_t[k] += t[k].dot(rest);
  }
}

void ContactNewton::start(std::span<const RigidContact> contacts) {
  gather(contacts);
  touching_.clear();
  const auto touch = [&](const int(&body)[2]) {
    if (body[0] >= 0 && body[1] >= 0) touching_.emplace_back(body[0], body[1]);
  };
  for (const Patch& patch : patches_) touch(patch.body);
  for (const Joint& joint : joint_states_) touch(joint.row->body);
  matrix_.setPattern(island_.bodies.size(), touching_);
  island_.readVelocities(u_);
}

// Adopts the round's impulses. Returns the greatest error of a contact's law [m/s].
double ContactNewton::endRound() {
  double law_m_s = 0;
  for (Point& p : points_) {
    law_m_s = std::max(law_m_s, p.softness * (p.next - p.impulse).norm());
    p.impulse = p.next;
  }
  for (const Joint& joint : joint_states_) joint.row->impulse_Ns = joint.next_Ns;
  return law_m_s;
}

SolveOutcome ContactNewton::solve(std::span<RigidContact> contacts, double residual_m_s, int step_limit) {
  constexpr int kRoundSteps = 12;  // assumed
  SolveOutcome outcome;
  start(contacts);
  double compliance = kFirstCompliance, last_m_s = std::numeric_limits<double>::infinity();
  for (;;) {
    setCompliance(compliance);
    const double near_m_s =
        kRoundShare * std::max(kAccuracyShare * residual_m_s, std::min(last_m_s, kFirstError_m_s));
    const SolveOutcome round = solveRound(near_m_s, std::min(kRoundSteps, step_limit - outcome.steps));
    outcome.steps += std::max(1, round.steps);
    if (!round.is_converged) {
      if (outcome.steps >= step_limit || !std::isfinite(off_m_s_)) break;
      compliance = std::min(1.0, compliance / kAccuracyShare);
      continue;
    }
    const double law_m_s = endRound();
    // The bodies get the velocities of the impulses, which differ from the laws' velocities by the imbalance.
    outcome.is_converged = off_m_s_ <= residual_m_s && law_m_s <= kAccuracyShare * residual_m_s;
    if (outcome.is_converged || outcome.steps >= step_limit) break;
    if (law_m_s > kAccuracyShare * last_m_s)
      compliance = std::max(kLeastCompliance, kRoundShare * compliance);
    last_m_s = law_m_s;
  }
  if (!std::all_of(u_.begin(), u_.end(), [](const Vec6& u) { return u.allFinite(); }))
    return {outcome.steps, false};
  writeImpulses(contacts);
  for (std::size_t i = 0; i < u_.size(); ++i) island_.bodies[i].u = u_[i];
  return outcome;
}

}  // namespace vps::bullet
