// SPDX-License-Identifier: BSD-3-Clause
// The solver's interface to the narrow phase: which contacts does a solved step lack?
//
// Contacts are planes, found for the motion that is predicted before the step. Contact changes the predicted
// motion: a part that breaks free of a jam turns, an edge that was out of reach meets a wall, and a fast turn
// bends the path of a point away from its plane. The solver therefore calls the check of each pair, which
// tells whether the bodies would overlap at the solved poses, and solves the step again with the missing
// contacts, a bounded number of times.
#pragma once

#include <cstddef>
#include <vector>

#include "vps/contact_tolerances.h"
#include "vps/pose.h"

class btCollisionObject;
class btManifoldPoint;

namespace vps::bullet {

/// A contact without which two bodies overlap at the end of the step.
struct MissedContact {
  btManifoldPoint* point = nullptr;  ///< a new point, or a point of the solver with another plane; null if
                                     ///< the manifolds are full
  const btCollisionObject* object[2] = {nullptr, nullptr};
  double end_gap_m = 0;  ///< gap at the end of the step, in the motion that was checked
  double kept_m =
      0;  ///< least gap at the end of the step; negative for an overlap that existed before the step
  double rest_m = 0;       ///< gap that the push restores
  bool is_sharp = false;   ///< the push of other contacts must not reduce the gap
  bool is_let_go = false;  ///< no surface faces the contact any more, so it loses its impulse
};

/// The number and kind of a check within a step.
struct CheckRound {
  int number = 0;      ///< from 0
  bool is_own = true;  ///< true if bullet::Solver solves the step; false: rows are not computed again

  /// True if small gaps are to be restored too.
  [[nodiscard]] bool isFirst() const { return is_own && number == 0; }
  /// True if contacts that carry load although they end the step apart may get new rows, or be let go.
  [[nodiscard]] bool mayRetake() const { return is_own && number < kMostRetakes; }
  /// True if rows are no longer computed again, so that the rounds of the solver come to an end.
  [[nodiscard]] bool isLate() const { return is_own && number >= kMostRetakes; }
};

/// A pair of bodies that checks a solved step.
class StepCheck {
 public:
  virtual ~StepCheck() = default;
  [[nodiscard]] virtual const btCollisionObject* object(int i) const = 0;
  /// Appends the contacts whose lever or normal turns during the step, with their rows at the end poses that
  /// the bodies would have at the last step's velocities. If lever and normal hardly turn, only contacts that
  /// carried load are appended. Rows at the start poses would brake or drive rolling bodies.
  virtual void linearise(const Pose (&X_WB_end)[2], std::vector<MissedContact>& out) = 0;
  /// Appends the contacts that the step lacks, and, in the first kMostRetakes checks, contacts that carry
  /// load although they end the step apart. Later checks do not correct rows, so that the rounds of the
  /// solver come to an end.
  /// @param X_WB_end  poses of the bodies' frames at the end of the step
  virtual void findMissed(const Pose (&X_WB_end)[2], CheckRound round, std::vector<MissedContact>& out) = 0;
  /// Greatest share of the step before sharp features of the bodies come too close together; 1 if they do
  /// not.
  virtual double freeShare(const Pose (&X_WB_end)[2]) = 0;
  /// Greatest share of the step, positive, during which no point of the bodies is much deeper than allowed or
  /// than before the step; 1 if no point is so deep at the end.
  virtual double freeShareOfPoints(const Pose (&X_WB_end)[2]) = 0;
  /// Must be called after the step: the check is not valid until the narrow phase visits the pair again,
  /// which it may never do if the user makes the bodies ignore each other.
  virtual void endStep() = 0;
};

}  // namespace vps::bullet
