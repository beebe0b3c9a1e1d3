// SPDX-License-Identifier: BSD-3-Clause
// What the narrow phase can say about a step that is solved: which contacts it lacked.
//
// Contacts are planes, found for the motion that is predicted before the step. Contact changes that motion: a
// part that breaks free of a jam turns, an edge that was out of reach meets a wall, and a fast turn bends the
// path of a point away from its plane. So the solver asks each pair whether the bodies would overlap at the
// poses that it found, and solves the step again with the contacts that were missing, a bounded number of
// times.
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
  btManifoldPoint* point = nullptr;  ///< new, or one that the solver has, with another plane; null: no room
  const btCollisionObject* object[2] = {nullptr, nullptr};
  double end_gap_m = 0;  ///< at the end of the step, in the motion that was checked
  double kept_m = 0;  ///< least gap at the end of the step; negative: an overlap that existed before the step
  double rest_m = 0;  ///< the gap that the push restores
  bool is_sharp = false;   ///< no other contact's push may take the gap
  bool is_let_go = false;  ///< nothing faces it any more: it loses its impulse
};

/// Which check of a step it is.
struct CheckRound {
  int number = 0;      ///< from 0
  bool is_own = true;  ///< bullet::Solver solves the step; false: rows stay where they were selected

  /// Gaps that are small already are restored.
  [[nodiscard]] bool isFirst() const { return is_own && number == 0; }
  /// Contacts that carry load although they end the step apart get other rows, or are let go.
  [[nodiscard]] bool mayRetake() const { return is_own && number < kMostRetakes; }
  /// Rounds are to end soon.
  [[nodiscard]] bool isLate() const { return is_own && number >= kMostRetakes; }
};

/// A pair of bodies that checks a solved step.
class StepCheck {
 public:
  virtual ~StepCheck() = default;
  [[nodiscard]] virtual const btCollisionObject* object(int i) const = 0;
  /// Appends the contacts whose lever or normal turns on the way, as they are where the bodies would be at
  /// the end of the step at the velocities of the last one. Where they turn by next to nothing, only those
  /// that carried load. Rows from the start pose would brake and drive what rolls.
  virtual void linearise(const Pose (&X_WB_end)[2], std::vector<MissedContact>& out) = 0;
  /// Appends the contacts that the step lacks, and in its first kMostRetakes checks those that carry load
  /// although they end it apart. Later a row is never taken back, so that the rounds end.
  /// @param X_WB_end  where the bodies' frames are at the end of the step
  virtual void findMissed(const Pose (&X_WB_end)[2], CheckRound round, std::vector<MissedContact>& out) = 0;
  /// The share of the step after which sharp features of the bodies would come too near; 1: they do not.
  virtual double freeShare(const Pose (&X_WB_end)[2]) = 0;
  /// The share of the step, positive, up to which points of the bodies are nowhere much deeper than allowed,
  /// or than they were before it; 1: they are not at its end either.
  virtual double freeShareOfPoints(const Pose (&X_WB_end)[2]) = 0;
  /// The step is solved: until the narrow phase visits the pair again, there is nothing to check. It may not
  /// do so, where the user made the bodies ignore each other.
  virtual void endStep() = 0;
};

}  // namespace vps::bullet
