// SPDX-License-Identifier: BSD-3-Clause
// The rounds of a step with rigid contact: it is solved with the contacts that are known, each pair is asked
// which ones the solution lacks (step_check.h), these are added, and it is solved again.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "solver/island/island.h"
#include "solver/island/joint_rows.h"
#include "solver/rigid/contact_newton.h"
#include "solver/rigid/contact_sweeps.h"
#include "solver/rigid/even_pressure.h"
#include "solver/rigid/step_check.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_motion.h"
#include "vps_bullet/solver.h"

struct btContactSolverInfo;

namespace vps::bullet {

/// Bodies, joints and contacts of one problem, and the pairs that check its solution. The caller fills them;
/// the memory is kept from one problem to the next.
class ContactLoop {
 public:
  Island island;
  JointRows joints;
  ContactSweeps contacts{island, joints};
  std::vector<StepCheck*> checks;  ///< one for each pair

  /// Error of a solution with which no check finds again what was solved: a row misses its target by twice
  /// the bodies' imbalance, and by a tenth of the residual. See FeatureMotion::kMissedShare.
  [[nodiscard]] static double allowedError_m_s(double dt_s) {
    return FeatureMotion::kMissedShare * FeatureMotion::kRest_m / (2.1 * dt_s);
  }
  /// Solves contacts and joints once, with the bodies' effective masses.
  SolveOutcome solveContacts(const SolverSettings& settings);

  /// Solves the step until no pair lacks a contact, at most nine times.
  /// @param solve  called without arguments in each round: solveContacts(), with what depends on its result
  /// @param is_own  bullet::Solver solves the step: contacts get the rows that they have at its end, where
  /// these differ, and flush faces an even pressure to start from
  /// @return the most steps of a round, and whether the last one converged
  template <typename Solve>
  SolveOutcome run(const btContactSolverInfo& info, int push_sweeps, bool is_own, const Solve& solve) {
    dt_s_ = info.m_timeStep;
    if (is_own) linearise(info);
    if (is_own) pressure_.spread(contacts.contacts());
    SolveOutcome outcome;
    for (int checked = 0;; ++checked) {
      const SolveOutcome round = solve();
      outcome = {std::max(outcome.steps, round.steps), round.is_converged};
      contacts.solvePush(info, push_sweeps);
      if (checked == kMostRounds || !addMissed(info, {checked, is_own})) return outcome;
    }
  }
  /// True if the rounds were used up, or no room was left, with contacts still missed.
  [[nodiscard]] bool hasMissed() const { return !missed_.empty(); }

 private:
  /// Of the bodies that contacts and joints act on.
  [[nodiscard]] double topSpeed();
  template <typename Visit>
  void forEachCheck(std::span<const Vec6> push, double dt_s, const Visit& visit) const;
  void linearise(const btContactSolverInfo& info);
  bool addMissed(const btContactSolverInfo& info, CheckRound round);

  EvenPressure pressure_{island};
  ContactNewton newton_{island, joints};
  std::vector<MissedContact> missed_;  // of the last check
  std::vector<Vec6> u_;                // scratch
  double dt_s_ = 0;
};

/// Where points would be too deep at the end of the step, or sharp features too near to each other, the
/// bodies of the pair, and those that hang together with them by joints and by contacts with load, move only
/// a share of their way: IslandBody::way_share. They keep the velocities of the solution, and the rest of the
/// step is spent in place. So they hit nothing harder than was solved, and the next step begins near contacts
/// that it then knows. A kinematic body goes on; what it comes to is not stopped for it in vain.
/// @param contacts, joints  of the solved island
/// @param push              its velocities, as ContactSweeps::push()
/// @return true if a body's way is shorter
bool endEarly(Island& island, std::span<const RigidContact> contacts, const JointRows& joints,
              std::span<StepCheck* const> checks, std::span<const Vec6> push, double dt_s);

}  // namespace vps::bullet
