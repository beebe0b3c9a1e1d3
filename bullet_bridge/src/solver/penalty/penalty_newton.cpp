// SPDX-License-Identifier: BSD-3-Clause
#include "solver/penalty/penalty_newton.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "solver/island/newton_math.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {
void PenaltyNewton::add(PenaltyPair& pair, int level, bool follows_rotation) {
  if (pair.points.empty()) return;
  const int body[2] = {island_.indexOf(pair.object[0]), island_.indexOf(pair.object[1])};
  if (body[0] < 0 && body[1] < 0) return;
  if (patch_count_ == patches_.size()) patches_.emplace_back();
  PenaltyPatch& patch = patches_[patch_count_++];
  patch.center.setZero();
  for (const PenaltyPoint& p : pair.points) patch.center += p.p_W;
  patch.center /= static_cast<double>(pair.points.size());
  patch.fixed.setZero();
  // Points of a rotating body move along circles, not along the tangents that a twist describes. Without this
  // term a nut would end each step slightly off its thread, and the restoring forces would slow it down.
  Mat3 off_tangent[2];
  for (int i = 0; i < 2; ++i) {
    patch.body[i] = body[i];
    const Vec6 now = Island::fixedVelocity(pair.object[i]);
    const double sign = i == 0 ? 1 : -1;
    patch.X[i] = sign * twistShift(fromBt(pair.object[i]->getWorldTransform().getOrigin()), patch.center);
    if (body[i] < 0) patch.fixed += patch.X[i] * now;
    const Vec3 turn = dt_s_ * now.head<3>();
    off_tangent[i] = follows_rotation ? Mat3(rotationFromVector(turn) - Mat3::Identity() - crossMatrix(turn))
                                      : Mat3(Mat3::Zero());
  }
  patch.build(pair, off_tangent, dt_s_, level);
}

std::size_t PenaltyNewton::pointCount() const {
  std::size_t count = 0;
  for (const PenaltyPatch& patch : patches()) count += patch.pointCount();
  return count;
}

Vec6 PenaltyNewton::twistOf(const PenaltyPatch& patch, const std::vector<Vec6>& u) const {
  Vec6 twist = patch.fixed;
  for (int i = 0; i < 2; ++i)
    if (patch.body[i] >= 0) twist += patch.X[i] * u[static_cast<std::size_t>(patch.body[i])];
  return twist;
}

void PenaltyNewton::evaluateAll(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    const IslandBody& b = island_.bodies[i];
    gradient[i] = b.effective_mass * u[i] - b.momentum - b.coupling_impulse;
  }
  for (std::size_t j = 0; j < joint_kg_.size(); ++j) {
    const JointRow& row = joints_.rows[j];
    const double impulse_Ns = jointImpulse(row, joint_kg_[j], u);
    is_free_[j] = impulse_Ns > row.lower_Ns && impulse_Ns < row.upper_Ns;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0) gradient[static_cast<std::size_t>(row.body[i])] -= impulse_Ns * row.J[i];
  }
  for (PenaltyPatch& patch : patches()) {
    patch.evaluate(twistOf(patch, u), with_hessian);
    for (int i = 0; i < 2; ++i)
      if (patch.body[i] >= 0)
        gradient[static_cast<std::size_t>(patch.body[i])] += patch.X[i].transpose() * patch.gradient;
  }
}

void PenaltyNewton::prepareJoints() {
  joint_kg_.clear();
  for (const JointRow& row : joints_.rows) {
    const double W = row.inverseMass(island_);
    joint_kg_.push_back(W > 0 ? 1 / (W * std::max(row.cfm, 1 / kRigidRatio)) : 0);
  }
  is_free_.assign(joints_.rows.size(), 0);
}

double PenaltyNewton::jointImpulse(const JointRow& row, double stiffness_kg,
                                   const std::vector<Vec6>& u) const {
  const double velocity = row.velocity([&](std::size_t i) -> const Vec6& { return u[i]; });
  return std::clamp(stiffness_kg * (row.target - velocity), row.lower_Ns, row.upper_Ns);
}

void PenaltyNewton::startMatrix() {
  thread_local std::vector<std::pair<int, int>> touching;
  touching.clear();
  const auto touch = [](const int(&body)[2]) {
    if (body[0] >= 0 && body[1] >= 0) touching.emplace_back(body[0], body[1]);
  };
  for (const PenaltyPatch& patch : patches()) touch(patch.body);
  for (const JointRow& row : joints_.rows) touch(row.body);
  hessian_.setPattern(island_.bodies.size(), touching);
  hessian_.setZero();
}

bool PenaltyNewton::newtonStep(const std::vector<Vec6>& gradient, std::vector<Vec6>& step) {
  if (gradient.size() == 1 && joint_kg_.empty()) {
    Mat6 H = island_.bodies[0].effective_mass;
    for (const PenaltyPatch& patch : patches()) {
      const Mat6& X = patch.X[patch.body[0] == 0 ? 0 : 1];
      H += X.transpose() * patch.hessian * X;
    }
    const Eigen::LLT<Mat6> factor(H);
    step[0] = -factor.solve(gradient[0]);
    return factor.info() == Eigen::Success;
  }
  startMatrix();
  for (std::size_t i = 0; i < gradient.size(); ++i)
    hessian_.add(static_cast<int>(i), static_cast<int>(i), island_.bodies[i].effective_mass);
  for (const PenaltyPatch& patch : patches())
    hessian_.addPair(patch.body, [&](int i, int j) -> Mat6 {
      return patch.X[i].transpose() * patch.hessian * patch.X[j];
    });
  for (std::size_t r = 0; r < joint_kg_.size(); ++r) {
    const JointRow& row = joints_.rows[r];
    if (is_free_[r])
      hessian_.addPair(row.body,
                       [&](int i, int j) -> Mat6 { return joint_kg_[r] * row.J[i] * row.J[j].transpose(); });
  }
  if (!hessian_.factorise()) return false;
  hessian_.solve(gradient, step);
  return true;
}

double PenaltyNewton::shareOfStep(const std::vector<Vec6>& u, const std::vector<Vec6>& step, double slope) {
  trial_.resize(u.size());
  trial_gradient_.resize(u.size());
  return lineSearch(slope, [&](double share) {
    for (std::size_t i = 0; i < u.size(); ++i) trial_[i] = u[i] + share * step[i];
    evaluateAll(trial_, false, trial_gradient_);
    return sumOfProducts(trial_gradient_, step);
  });
}

double PenaltyNewton::greatestSpeed(const std::vector<Vec6>& step) const {
  if (!joint_kg_.empty()) return island_.topSpeed(step);  // joints may move bodies without contact
  double speed_m_s = 0;
  for (const PenaltyPatch& patch : patches()) {
    const Vec6 twist = twistOf(patch, step) - patch.fixed;
    speed_m_s = std::max(speed_m_s, twist.tail<3>().norm() + twist.head<3>().norm() * patch.radius_m);
  }
  return speed_m_s;
}

double PenaltyNewton::imbalance_m_s() {
  trial_.resize(gradient_.size());
  for (std::size_t i = 0; i < gradient_.size(); ++i)
    trial_[i] = island_.bodies[i].effective_inverse * gradient_[i];
  return island_.topSpeed(trial_);
}

SolveOutcome PenaltyNewton::solve(double residual_m_s, int iteration_limit, End end) {
  prepareJoints();
  island_.readVelocities(u_);
  gradient_.resize(u_.size());
  step_.resize(u_.size());
  SolveOutcome outcome;
  while (outcome.steps < iteration_limit && !outcome.is_converged) {
    ++outcome.steps;
    evaluateAll(u_, true, gradient_);
    if (end == End::Balanced && imbalance_m_s() < residual_m_s) {
      outcome.is_converged = true;
      break;
    }
    if (!newtonStep(gradient_, step_)) break;
    const double slope = sumOfProducts(gradient_, step_);
    if (!(slope < 0)) {  // rounding allows no smaller gradient, or a value is not finite
      outcome.is_converged =
          slope >= 0 && (end == End::Short || imbalance_m_s() < residual_m_s / kAccuracyShare);
      break;
    }
    // The last step is so short that it needs no line search.
    outcome.is_converged = end == End::Short && greatestSpeed(step_) < residual_m_s;
    const double share = outcome.is_converged ? 1 : shareOfStep(u_, step_, slope);
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += share * step_[i];
  }
  for (std::size_t i = 0; i < u_.size(); ++i) island_.bodies[i].u = u_[i];
  return outcome;
}

double PenaltyNewton::updateLimits() {
  island_.readVelocities(u_);
  double change = 0, greatest = 0;
  for (PenaltyPatch& patch : patches()) patch.updateLimits(twistOf(patch, u_), change, greatest);
  return greatest > 0 ? change / greatest : change;
}

void PenaltyNewton::finish() {
  island_.readVelocities(u_);
  for (std::size_t j = 0; j < joint_kg_.size(); ++j)
    joints_.rows[j].impulse_Ns = jointImpulse(joints_.rows[j], joint_kg_[j], u_);
  for (const PenaltyPatch& patch : patches()) patch.finish(twistOf(patch, u_));
}

}  // namespace vps::bullet
