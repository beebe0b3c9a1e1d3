// SPDX-License-Identifier: BSD-3-Clause
// Constraint contacts for which sweeps do not converge: many contacts on one body, a few bodies that touch, a
// heavy body on a light one.
//
// The method of multipliers: each contact is a penalty point of moderate stiffness, offset by the impulse
// found so far. Newton's method balances all of them at once, for any masses. The forces found become the
// impulses of the next round, so that the compliance leaves no error in the end. Coulomb's limit is that of
// the previous round and is updated with it. Sources: Hestenes 1969 and Powell 1969 for multipliers; Alart
// and Curnier 1991 for contact and friction with them.
#pragma once

#include <span>
#include <vector>

#include "solver/contact_sweeps.h"
#include "solver/penalty_newton.h"

namespace vps::bullet::inline v0 {

class RigidNewton {
 public:
  RigidNewton(Island& island, JointRows& joints) : island_(island), penalty_(island, joints) {}

  /// Updates the impulses of contacts and joints and the bodies' velocities. The contacts' rows must be
  /// prepared. Cost of a step: a factorisation of 6n x 6n for n bodies, sparse if n is large, and about 0.1
  /// us a contact.
  /// @param residual_m_s  converged: no row of a contact misses its velocity by more, and the last round
  /// changed no
  ///                      velocity by more; rows of joints miss theirs by a millionth of the velocity
  ///                      corrected
  /// @param step_limit    Newton's steps, over all rounds
  SolveOutcome solve(std::span<RigidContact> contacts, double dt_s, double residual_m_s, int step_limit);

 private:
  [[nodiscard]] std::span<PenaltyPair> pairs() { return {pairs_.data(), pair_count_}; }
  void setPenaltyPoints(std::span<const RigidContact> contacts, double dt_s);
  double readImpulses(std::span<RigidContact> contacts, double dt_s);

  [[nodiscard]] double changeInRound_m_s();

  Island& island_;
  PenaltyNewton penalty_;
  double compliance_ = 0;
  std::vector<PenaltyPair> pairs_;  // the first pair_count_ are in use; kept to reuse their memory
  std::size_t pair_count_ = 0;
  std::vector<Vec6> before_, change_;  // velocities of the previous round, and their change
};

}  // namespace vps::bullet::inline v0
