// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid_newton.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

// What a spring gives, as a share of what a free body would: at first, and at least. A stiff one leaves
// little error in a round but takes Newton's method many steps from afar, a soft one the reverse. So a round
// that has not brought what is missed down to kGood of the round before is followed by stiffer ones
// [Bertsekas 1982, ch. 2].
constexpr double kSoftest = 1e-2, kStiffest = 1e-5, kStiffer = 0.1, kGood = 0.25;
// A round's answer is only as good as its limits of friction: it need not be nearer than this share of what
// the round before has missed.
constexpr double kShareOfMissed = 0.1, kFirstMissed_m_s = 1e-2;
// Steps in one round; most take one to three.
constexpr int kStepsPerRound = 20;

bool isOfPair(const RigidContact& c, const PenaltyPair& pair) {
  return c.object[0] == pair.object[0] && c.object[1] == pair.object[1] && c.mu == pair.mu;
}

Vec3 tangentOf(const RigidContact& c, int k) {
  return fromBt(k == 0 ? c.point->m_lateralFrictionDir1 : c.point->m_lateralFrictionDir2);
}

PenaltyPoint springOf(const RigidContact& c, double dt_s, double softness) {
  PenaltyPoint p;
  p.p_W = 0.5 * fromBt(c.point->getPositionWorldOnA() + c.point->getPositionWorldOnB());
  p.n_W = fromBt(c.point->m_normalWorldOnB);
  p.k_N_per_m = 1 / (softness * c.normal.W * dt_s * dt_s);
  p.f_n_N = c.p_n / dt_s;
  p.gap_m = -c.target_m_s * dt_s - p.f_n_N / p.k_N_per_m;
  // A bend is body 0's way against body 1, the impulse on body 0 against it.
  p.bend_W = -(c.p_t[0] * tangentOf(c, 0) + c.p_t[1] * tangentOf(c, 1)) / (dt_s * p.k_N_per_m);
  return p;
}

}  // namespace

void RigidNewton::setAbout(std::span<const RigidContact> contacts, double dt_s) {
  pair_count_ = 0;
  for (const RigidContact& c : contacts) {
    if (pair_count_ == 0 || !isOfPair(c, pairs_[pair_count_ - 1])) {
      if (pair_count_ == pairs_.size()) pairs_.emplace_back();
      PenaltyPair& pair = pairs_[pair_count_++];
      for (int i = 0; i < 2; ++i) pair.object[i] = c.object[i];
      pair.mu = c.mu;
      pair.points.clear();
    }
    pairs_[pair_count_ - 1].points.push_back(springOf(c, dt_s, softness_));
  }
  springs_.clear(dt_s);
  for (PenaltyPair& pair : pairs()) springs_.add(pair, false);  // nor do sweeps foresee it
}

// Returns the greatest give of a spring, which is the velocity by which its row misses its law.
double RigidNewton::takeImpulses(std::span<RigidContact> contacts, double dt_s) {
  double give_m_s = 0;
  auto c = contacts.begin();
  for (const PenaltyPair& pair : pairs())
    for (const PenaltyPoint& p : pair.points) {
      const double p_n = dt_s * p.f_n_N;
      const Vec3 impulse_t = -dt_s * p.k_N_per_m * p.bend_W;
      const double p_t[2] = {impulse_t.dot(tangentOf(*c, 0)), impulse_t.dot(tangentOf(*c, 1))};
      const double change_Ns =
          std::abs(p_n - c->p_n) + std::abs(p_t[0] - c->p_t[0]) + std::abs(p_t[1] - c->p_t[1]);
      give_m_s = std::max(give_m_s, softness_ * c->normal.W * change_Ns);
      c->p_n = p_n;
      c->p_t[0] = p_t[0];
      c->p_t[1] = p_t[1];
      ++c;
    }
  return give_m_s;
}

double RigidNewton::changeSinceKept_m_s() {
  change_.clear();
  for (std::size_t i = 0; i < before_.size(); ++i) change_.push_back(island_.bodies[i].u - before_[i]);
  return island_.topSpeed(change_);
}

SolveOutcome RigidNewton::solve(std::span<RigidContact> contacts, double dt_s, double residual_m_s,
                                int step_limit) {
  SolveOutcome outcome;
  softness_ = kSoftest;
  double missed_m_s = std::numeric_limits<double>::infinity();
  island_.readVelocities(before_);
  while (outcome.steps < step_limit && missed_m_s > residual_m_s) {
    setAbout(contacts, dt_s);
    const double near_m_s = kShareOfMissed * std::clamp(missed_m_s, residual_m_s, kFirstMissed_m_s);
    const int limit = std::min(kStepsPerRound, step_limit - outcome.steps);
    const SolveOutcome round = springs_.solve(near_m_s, limit, PenaltyNewton::End::Balanced);
    outcome.steps += round.steps;
    // Cut short, springs have pushed by more than they should: that would be energy from nowhere.
    if (!round.is_settled) break;
    springs_.finish();
    // What new limits of friction do to the velocities counts as much as what springs give, and so does
    // what the round left out of balance: the velocities are the springs', not what the impulses give.
    const double now_m_s =
        std::max({takeImpulses(contacts, dt_s), changeSinceKept_m_s(), springs_.imbalance_m_s()});
    if (now_m_s > kGood * missed_m_s) softness_ = std::max(kStiffest, kStiffer * softness_);
    missed_m_s = now_m_s;
    island_.readVelocities(before_);
  }
  outcome.is_settled = missed_m_s <= residual_m_s;
  return outcome;
}

}  // namespace vps::bullet
