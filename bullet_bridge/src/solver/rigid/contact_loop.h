// SPDX-License-Identifier: BSD-3-Clause
// The rounds of a step with rigid contact: solve with the known contacts, call the check of each pair
// (step_check.h), add the contacts that the solution lacks, and solve again.
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

/// Bodies, joints and contacts of one problem, and the checks of its pairs. The caller fills these lists; the
/// memory is reused for the next problem.
class ContactLoop {
 public:
  Island island;
  JointRows joints;
  ContactSweeps contacts{island, joints};
  std::vector<StepCheck*> checks;  ///< one check per pair

  /// Greatest error of a solution for which a check does not find the same contact again: a row misses its
  /// target by twice the bodies' imbalance plus a tenth of the residual. See FeatureMotion::kMissedShare.
  [[nodiscard]] static double allowedError_m_s(double dt_s) {
    return FeatureMotion::kMissedShare * FeatureMotion::kRest_m / (2.1 * dt_s);
  }
  /// Solves contacts and joints once, with the bodies' effective masses.
  SolveOutcome solveContacts(const SolverSettings& settings);

  /// Solves the step until no pair lacks a contact, at most nine times.
  /// @param solve  called without arguments in each round; calls solveContacts() and updates what depends on
  ///   its result
  /// @param is_own  true if bullet::Solver solves the step: rows are then taken at the end of the step if
  ///   they differ there, and flush faces start from an even pressure
  /// @return greatest number of steps of a round, and whether the last round converged
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
  /// True if contacts are still missed because the rounds or the manifolds' room were used up.
  [[nodiscard]] bool hasMissed() const { return !missed_.empty(); }

 private:
  /// Greatest speed of the bodies on which contacts and joints act.
  [[nodiscard]] double topSpeed();
  template <typename Visit>
  void forEachCheck(std::span<const Vec6> push, double dt_s, const Visit& visit) const;
  void linearise(const btContactSolverInfo& info);
  bool addMissed(const btContactSolverInfo& info, CheckRound round);

  EvenPressure pressure_{island};
  ContactNewton newton_{island, joints};
  std::vector<MissedContact> missed_;  // contacts missed in the last check
  std::vector<Vec6> u_;                // scratch
  double dt_s_ = 0;
};

/// Shortens the motion of bodies for which contacts are still missed: if points would be too deep at the end
/// of the step, or sharp features too close, the bodies of the pair, and bodies connected to them by joints
/// and loaded contacts, move only a share of the step (IslandBody::way_share). The bodies keep the velocities
/// of the solution, so their impacts are no faster than in the solution, and the next step begins near
/// contacts that it then finds. A kinematic body is not shortened.
/// @param contacts, joints  of the solved island
/// @param push  the push, as from ContactSweeps::push()
/// @return true if the motion of a body was shortened
bool endEarly(Island& island, std::span<const RigidContact> contacts, const JointRows& joints,
              std::span<StepCheck* const> checks, std::span<const Vec6> push, double dt_s);

}  // namespace vps::bullet
