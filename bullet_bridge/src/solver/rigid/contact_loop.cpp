// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid/contact_loop.h"

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

// For parts near rest, sweeps converge within a few microseconds. Otherwise Newton's method follows, which
// solves the whole island at once.
SolveOutcome ContactLoop::solveContacts(const SolverSettings& settings) {
  constexpr int kSweepsFirst = 30,
                kSweepsPerNewtonStep = 10;  // assumed; kSweepsPerNewtonStep is the ratio of the costs
  // An arch of 101 stones needs 120 steps of Newton's method until it stands. With 60 steps the arch keeps
  // moving, and needs 60 steps of Newton's method again in each time step.
  constexpr int kStepsPerBody = 3;
  // A lower limit costs more time than convergence: each step would then be solved repeatedly for the
  // contacts that it misses.
  const int newton_share = std::max(0, settings.iteration_limit - kSweepsFirst) / kSweepsPerNewtonStep;
  const int most = std::max(kMostIterations, kStepsPerBody * static_cast<int>(island.bodies.size()));
  const int newton_limit = newton_share > 0 ? std::max(most, newton_share) : 0;
  contacts.start();
  SolveOutcome outcome =
      contacts.sweep(settings.residual_m_s, newton_limit > 0 ? kSweepsFirst : settings.iteration_limit);
  if (outcome.is_converged || newton_limit == 0) return outcome;
  const double near_m_s =
      std::max(settings.residual_m_s, std::min(kSpeedErrorShare * topSpeed(), allowedError_m_s(dt_s_)));
  const SolveOutcome solved = newton_.solve(contacts.contacts(), near_m_s, newton_limit);
  outcome.steps += kSweepsPerNewtonStep * solved.steps;
  outcome.is_converged = solved.is_converged;
  contacts.applyImpulses();  // even without convergence, velocities follow from the impulses
  if (solved.is_converged) return outcome;
  const SolveOutcome end =
      contacts.sweep(settings.residual_m_s, std::max(kSweepsFirst, settings.iteration_limit - outcome.steps));
  return {outcome.steps + end.steps, end.is_converged};
}

// A body that flies by without contact does not lower the accuracy of bodies at rest.
double ContactLoop::topSpeed() {
  u_.assign(island.bodies.size(), Vec6::Zero());
  const auto read = [&](int body) {
    if (body >= 0) u_[static_cast<std::size_t>(body)] = island.bodies[static_cast<std::size_t>(body)].u;
  };
  for (int k : {0, 1}) {
    for (const RigidContact& c : contacts.contacts()) read(c.normal.side[k].body);
    for (const JointRow& joint : joints.rows) read(joint.body[k]);
  }
  return island.topSpeed(u_);
}

/// Calls visit(check, end poses of its bodies) for each check.
template <typename Visit>
void ContactLoop::forEachCheck(std::span<const Vec6> push, double dt_s, const Visit& visit) const {
  for (StepCheck* check : checks) {
    const Pose X_WB_end[2] = {island.endPose(check->object(0), push, dt_s),
                              island.endPose(check->object(1), push, dt_s)};
    visit(*check, X_WB_end);
  }
}

// Computes the rows of contacts whose lever or normal turns during the step, at the poses that the bodies
// reach by the end of the step with their present velocities.
void ContactLoop::linearise(const btContactSolverInfo& info) {
  missed_.clear();
  forEachCheck({}, info.m_timeStep,
               [&](StepCheck& check, const Pose(&X_WB_end)[2]) { check.linearise(X_WB_end, missed_); });
  contacts.addMissed(missed_, info);
}

// Returns true if contacts were added, so that the step must be solved again.
bool ContactLoop::addMissed(const btContactSolverInfo& info, CheckRound round) {
  missed_.clear();
  contacts.finish();  // writes impulses, from which a check reads which contacts carry load
  forEachCheck(contacts.push(), info.m_timeStep, [&](StepCheck& check, const Pose(&X_WB_end)[2]) {
    check.findMissed(X_WB_end, round, missed_);
  });
  contacts.addMissed(missed_, info);
  return std::any_of(missed_.begin(), missed_.end(),
                     [](const MissedContact& m) { return m.point != nullptr; });
}

}  // namespace vps::bullet
