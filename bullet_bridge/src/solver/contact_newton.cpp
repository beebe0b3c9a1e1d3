// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact_newton.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/line_search.h"
#include "solver/patch_math.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {

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

// mu |v_t|
double ContactNewton::slipOf(const Point& p, const Vec6& twist) {
  const Vec3 v = twist.tail<3>() + Vec3(twist.head<3>()).cross(p.r);
  return p.mu * (v - p.n.dot(v) * p.n).norm();
}

// The impulse at a relative velocity: the projection onto the cone; with its derivative, times -1.
void ContactNewton::project(Point& p, const Vec3& v, SymmetricSum* hessian) {
  const double k = 1 / p.softness;
  const Vec3 y = p.impulse + k * ((p.target - p.slip) * p.n - v);
  const double y_n = p.n.dot(y);
  const Vec3 y_t = y - y_n * p.n;
  const double length = y_t.norm();
  if (y_n > 0 && length <= p.mu * y_n) {  // sticks
    p.next = y;
    if (hessian) hessian->addEven(k, p.r);
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
  if (!hessian) return;
  hessian->add(k * share, wrenchOf(p.r, edge));
  if (p.mu > 0 && length > 0) hessian->add(k * p.mu * p_n / length, wrenchOf(p.r, p.n.cross(t)));
}

void ContactNewton::evaluateJoints(const std::vector<Vec6>& u, std::vector<Vec6>& gradient) {
  for (Joint& joint : joint_states_) {
    const JointRow& row = *joint.row;
    const double v = row.velocity([&](std::size_t i) -> const Vec6& { return u[i]; });
    const double wanted_Ns = (row.target - v) / joint.softness;
    joint.next_Ns = std::clamp(wanted_Ns, row.lower_Ns, row.upper_Ns);
    joint.is_free = joint.next_Ns == wanted_Ns;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0) gradient[static_cast<std::size_t>(row.body[i])] -= joint.next_Ns * row.J[i];
  }
}

// The gradient of the round's function at u; with_hessian: also the Hessians of the patches.
void ContactNewton::evaluate(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient) {
  gradient.resize(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const IslandBody& b = island_.bodies[i];
    gradient[i] = b.effective_mass * u[i] - b.momentum - b.coupling_impulse;
  }
  evaluateJoints(u, gradient);
  for (Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u);
    const Vec3 w = twist.head<3>(), v = twist.tail<3>();
    SymmetricSum hessian;
    Vec6 wrench = Vec6::Zero();
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      Point& p = points_[i];
      project(p, v + w.cross(p.r), with_hessian ? &hessian : nullptr);
      wrench += wrenchOf(p.r, p.next);
    }
    if (with_hessian) patch.hessian = hessian.total();
    for (int i = 0; i < 2; ++i)
      if (patch.body[i] >= 0)
        gradient[static_cast<std::size_t>(patch.body[i])] -= patch.X[i].transpose() * wrench;
  }
}

// False: the matrix is not positive definite.
bool ContactNewton::findStep() {
  step_.resize(u_.size());
  return u_.size() == 1 ? findStepOfOne() : findStepOfAll();
}

bool ContactNewton::findStepOfOne() {
  Mat6 H = island_.bodies[0].effective_mass;
  for (const Patch& patch : patches_) {
    const Mat6& X = patch.X[patch.body[0] == 0 ? 0 : 1];
    H += X.transpose() * patch.hessian * X;
  }
  for (const Joint& joint : joint_states_) {
    if (!joint.is_free) continue;
    const Vec6& J = joint.row->J[joint.row->body[0] == 0 ? 0 : 1];
    H += 1 / joint.softness * J * J.transpose();
  }
  const Eigen::LLT<Mat6> factor(H);
  step_[0] = -factor.solve(gradient_[0]);
  return factor.info() == Eigen::Success;
}

bool ContactNewton::findStepOfAll() {
  matrix_.start(u_.size(), touching_);
  for (std::size_t i = 0; i < u_.size(); ++i)
    matrix_.add(static_cast<int>(i), static_cast<int>(i), island_.bodies[i].effective_mass);
  for (const Patch& patch : patches_)
    matrix_.addPair(patch.body, [&](int i, int j) -> Mat6 {
      return patch.X[i].transpose() * patch.hessian * patch.X[j];
    });
  for (const Joint& joint : joint_states_) {
    const double k = 1 / joint.softness;
    const auto& J = joint.row->J;
    if (joint.is_free)
      matrix_.addPair(joint.row->body, [&](int i, int j) -> Mat6 { return k * J[i] * J[j].transpose(); });
  }
  if (!matrix_.factorise()) return false;
  matrix_.solve(gradient_, step_);
  return true;
}

double ContactNewton::shareOfStep(double slope) {
  trial_.resize(u_.size());
  return lineSearch(slope, [&](double share) {
    for (std::size_t i = 0; i < u_.size(); ++i) trial_[i] = u_[i] + share * step_[i];
    evaluate(trial_, false, trial_gradient_);
    return sumOfProducts(trial_gradient_, step_);
  });
}

// Change of the bodies' velocities by the momentum that is missing at u.
double ContactNewton::imbalance_m_s() {
  scratch_.resize(u_.size());
  for (std::size_t i = 0; i < u_.size(); ++i)
    scratch_[i] = island_.bodies[i].effective_inverse * gradient_[i];
  return island_.topSpeed(scratch_);
}

SolveOutcome ContactNewton::minimise(double near_m_s, int step_limit) {
  SolveOutcome outcome;
  for (;;) {
    evaluate(u_, true, gradient_);
    off_m_s_ = imbalance_m_s();
    outcome.is_converged = off_m_s_ <= near_m_s;
    if (outcome.is_converged || outcome.steps >= step_limit || !std::isfinite(off_m_s_)) return outcome;
    if (!findStep()) return outcome;
    const double slope = sumOfProducts(gradient_, step_);
    if (!(slope < 0)) {  // balanced as well as rounding allows
      outcome.is_converged = slope >= 0 && off_m_s_ < near_m_s / kAccuracyShare;
      return outcome;
    }
    const double share = shareOfStep(slope);
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += share * step_[i];
    ++outcome.steps;
  }
}

void ContactNewton::writeImpulses(std::span<RigidContact> contacts) const {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    RigidContact& c = contacts[i];
    const Vec3& impulse = points_[i].impulse;
    const Vec3 &n = points_[i].n, t[2] = {c.tangent_W(0), c.tangent_W(1)};
    c.p_n = n.dot(impulse);
    for (int k = 0; k < 2; ++k) c.p_t[k] = t[k].dot(impulse);
    // Directions of floats are not quite of unit length, nor quite at right angles. Where a light body is
    // between heavy ones, the rest of an impulse moves it by a micrometre a second.
    const Vec3 rest = impulse - (c.p_n * n + c.p_t[0] * t[0] + c.p_t[1] * t[1]);
    // Above the rounding of doubles, so that these keep their bits.
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
  island_.readVelocities(u_);
  extrapolation_.clear();
  startSlips();
}

SolveOutcome ContactNewton::solve(std::span<RigidContact> contacts, double residual_m_s, int step_limit) {
  SolveOutcome outcome;
  start(contacts);
  double compliance = kFirstCompliance;
  Miss last = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (;;) {
    setCompliance(compliance);
    const double error_m_s = std::max(last.law_m_s, last.slip_m_s);
    const double near_m_s =
        kAccuracyShare * std::clamp(error_m_s, kAccuracyShare * residual_m_s, kFirstError_m_s);
    const SolveOutcome round = minimise(near_m_s, step_limit - outcome.steps);
    outcome.steps += std::max(1, round.steps);
    if (!round.is_converged) break;
    const Miss now = endRound();
    // The bodies get the velocities of the impulses, which differ from those of the laws by the imbalance.
    outcome.is_converged = off_m_s_ <= residual_m_s && now.law_m_s <= kAccuracyShare * residual_m_s &&
                           now.slip_m_s <= residual_m_s;
    if (outcome.is_converged || outcome.steps >= step_limit) break;
    if (now.slip_m_s > last.slip_m_s) extrapolation_.clear();
    updateSlips();
    if (now.law_m_s > kAccuracyShare * last.law_m_s && !now.isOfSlip(last))
      compliance = std::max(kLeastCompliance, kAccuracyShare * compliance);
    last = now;
  }
  if (!std::all_of(u_.begin(), u_.end(), [](const Vec6& u) { return u.allFinite(); }))
    return {outcome.steps, false};
  writeImpulses(contacts);
  for (std::size_t i = 0; i < u_.size(); ++i) island_.bodies[i].u = u_[i];
  return outcome;
}

}  // namespace vps::bullet::inline v0
