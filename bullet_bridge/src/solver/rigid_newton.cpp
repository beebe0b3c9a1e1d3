// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vps::bullet::inline v0 {
namespace {

// Compliance of a contact relative to that of a free body: initial and least value. A stiff contact leaves
// little error in a round, but Newton's method needs many steps from a distant start; for a compliant one it
// is the reverse. So a round that has not reduced the error to kGoodReduction of the previous round's is
// followed by stiffer ones [Bertsekas 1982, ch. 2].
constexpr double kMaxCompliance = 1e-2, kMinCompliance = 1e-5, kStiffer = 0.1, kGoodReduction = 0.25;
// The solution of a round is only as good as its limits of friction, so it need not be more accurate than
// this share of the previous round's error.
constexpr double kShareOfError = 0.1, kFirstError_m_s = 1e-2;
// Steps in one round; most take one to three.
constexpr int kStepsPerRound = 20;

bool isOfPair(const RigidContact& c, const PenaltyPair& pair) {
  return c.object[0] == pair.object[0] && c.object[1] == pair.object[1] && c.mu == pair.points.front().mu;
}

PenaltyPoint penaltyPointOf(const RigidContact& c, double dt_s, double compliance) {
  PenaltyPoint p;
  p.p_W = c.position_W();
  p.n_W = c.normal_W();
  p.mu = c.mu;
  p.k_N_per_m = 1 / (compliance * c.normal.W * dt_s * dt_s);
  p.f_n_N = c.p_n / dt_s;
  p.gap_m = -c.target_m_s * dt_s - p.f_n_N / p.k_N_per_m;
  // The bend is the displacement of body 0 relative to body 1; the impulse on body 0 opposes it.
  p.bend_W = -(c.p_t[0] * c.tangent_W(0) + c.p_t[1] * c.tangent_W(1)) / (dt_s * p.k_N_per_m);
  return p;
}

}  // namespace

void RigidNewton::setPenaltyPoints(std::span<const RigidContact> contacts, double dt_s) {
  pair_count_ = 0;
  for (const RigidContact& c : contacts) {
    if (pair_count_ == 0 || !isOfPair(c, pairs_[pair_count_ - 1])) {
      if (pair_count_ == pairs_.size()) pairs_.emplace_back();
      PenaltyPair& pair = pairs_[pair_count_++];
      for (int i = 0; i < 2; ++i) pair.object[i] = c.object[i];
      pair.points.clear();
    }
    pairs_[pair_count_ - 1].points.push_back(penaltyPointOf(c, dt_s, compliance_));
  }
  penalty_.clear(dt_s);
  for (PenaltyPair& pair : pairs()) penalty_.add(pair, 0, false);  // as the sweeps do
}

// Returns the greatest velocity by which a row misses its law.
double RigidNewton::readImpulses(std::span<RigidContact> contacts, double dt_s) {
  double error_m_s = 0;
  auto c = contacts.begin();
  for (const PenaltyPair& pair : pairs())
    for (const PenaltyPoint& p : pair.points) {
      const double p_n = dt_s * p.f_n_N;
      const Vec3 impulse_t = -dt_s * p.k_N_per_m * p.bend_W;
      const double p_t[2] = {impulse_t.dot(c->tangent_W(0)), impulse_t.dot(c->tangent_W(1))};
      const double change_Ns =
          std::abs(p_n - c->p_n) + std::abs(p_t[0] - c->p_t[0]) + std::abs(p_t[1] - c->p_t[1]);
      error_m_s = std::max(error_m_s, compliance_ * c->normal.W * change_Ns);
      c->p_n = p_n;
      c->p_t[0] = p_t[0];
      c->p_t[1] = p_t[1];
      ++c;
    }
  return error_m_s;
}

double RigidNewton::changeInRound_m_s() {
  change_.clear();
  for (std::size_t i = 0; i < before_.size(); ++i) change_.push_back(island_.bodies[i].u - before_[i]);
  return island_.topSpeed(change_);
}

SolveOutcome RigidNewton::solve(std::span<RigidContact> contacts, double dt_s, double residual_m_s,
                                int step_limit) {
  SolveOutcome outcome;
  compliance_ = kMaxCompliance;
  double error_m_s = std::numeric_limits<double>::infinity();
  island_.readVelocities(before_);
  while (outcome.steps < step_limit && error_m_s > residual_m_s) {
    setPenaltyPoints(contacts, dt_s);
    const double near_m_s = kShareOfError * std::clamp(error_m_s, residual_m_s, kFirstError_m_s);
    const int limit = std::min(kStepsPerRound, step_limit - outcome.steps);
    const SolveOutcome round = penalty_.solve(near_m_s, limit, PenaltyNewton::End::Balanced);
    outcome.steps += round.steps;
    // Without convergence the contacts have pushed too much, which would add energy.
    if (!round.is_converged) break;
    penalty_.finish();
    // The error also includes the velocity change by the new limits of friction and the momentum that the
    // round left out of balance: the velocities are those of the penalty points, not of the impulses.
    const double now_m_s =
        std::max({readImpulses(contacts, dt_s), changeInRound_m_s(), penalty_.imbalance_m_s()});
    if (now_m_s > kGoodReduction * error_m_s) compliance_ = std::max(kMinCompliance, kStiffer * compliance_);
    error_m_s = now_m_s;
    island_.readVelocities(before_);
  }
  outcome.is_converged = error_m_s <= residual_m_s;
  return outcome;
}

}  // namespace vps::bullet::inline v0
