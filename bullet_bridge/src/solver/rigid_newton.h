// SPDX-License-Identifier: BSD-3-Clause
// Rigid contacts that sweeps do not settle: many contacts on one body, heaps, a heavy body on a light one.
//
// The method of multipliers: each contact is a spring of moderate stiffness about the impulse found so far.
// Newton's method balances all springs at once, whatever the masses; what they then give becomes the impulse
// they are set about next, so that their softness leaves no error in the end. Coulomb's limit is that of the
// round before, and is renewed with it. Sources: Hestenes 1969 and Powell 1969 for multipliers; Alart and
// Curnier 1991 for contact and friction by them.
#pragma once

#include <span>
#include <vector>

#include "solver/contact_sweeps.h"
#include "solver/penalty_newton.h"

namespace vps::bullet {

class RigidNewton {
 public:
  RigidNewton(Island& island, JointRows& joints) : island_(island), springs_(island, joints) {}

  /// Renews the contacts' and the joints' impulses and the bodies' velocities; the contacts' rows are
  /// prepared. Cost of a step: a factorisation of 6n x 6n for n bodies, sparse where they are many, and some
  /// 0.1 us a contact.
  /// @param residual_m_s  settled: no contact's row misses its velocity by more, and the last round changed
  /// none by
  ///                      more; joints' rows miss theirs by a millionth of what they are pushed
  /// @param step_limit    Newton's steps, over all rounds
  SolveOutcome solve(std::span<RigidContact> contacts, double dt_s, double residual_m_s, int step_limit);

 private:
  [[nodiscard]] std::span<PenaltyPair> pairs() { return {pairs_.data(), pair_count_}; }
  void setAbout(std::span<const RigidContact> contacts, double dt_s);
  double takeImpulses(std::span<RigidContact> contacts, double dt_s);

  [[nodiscard]] double changeSinceKept_m_s();

  Island& island_;
  PenaltyNewton springs_;
  double softness_ = 0;
  std::vector<PenaltyPair> pairs_;  // the first pair_count_ of them; kept for their memory
  std::size_t pair_count_ = 0;
  std::vector<Vec6> before_, change_;  // velocities of the round before, and what became of them
};

}  // namespace vps::bullet
