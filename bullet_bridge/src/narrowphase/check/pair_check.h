// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a solved step lets the bodies of a pair overlap, and finds the contacts that prevent it.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/check/feature_check.h"
#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "solver/rigid/step_check.h"

class btDispatcher;

namespace vps::bullet {

/// Checks the solved step of one pair in four stages. Each stage runs only if the one before cannot exclude
/// an overlap:
///
///   1. Bounds of the motion: how far any point moved relative to the other body, and how far from the
///      position that was predicted.
///   2. The points that were refined for the step's selection, including those that the selection left out:
///      the exact gaps of their planes at the end of the step. (The solver's gaps are first-order in the
///      motion.)
///   3. The exact motion of corners, sharp edges and facets (feature_check.h).
///   4. A query of all points at the end of the step, and, for a fast body, at places along its path; and
///      of the vertices of facets that protrude between the points (facet_corners.cpp). Curved faces are
///      checked between their points as well (SamplingError).
///
/// Bodies that turn against each other by more than kContactTurn_rad are checked in stages 3 and 4 only.
/// Planes are then not carried along: a point's gaps before and after the step are measured at the poses of
/// these times.
///
/// A missing contact gets the plane through which the point entered.
///
/// The check also corrects contacts that carry load although they end the step apart. A contact plane is
/// first-order in the motion; if the step turned it away, the contact gets the plane that it has at the end.
class PairCheck final : public StepCheck {
 public:
  explicit PairCheck(PairState& state) : state_(state) {}

  /// Must be called in each step before the step is solved, since Bullet's wrappers live for one call.
  void setBodies(const PairView& pair);
  /// False if Bullet did not process the pair in this step: its shapes may have changed or been deleted.
  [[nodiscard]] bool isValid() const;
  [[nodiscard]] const btCollisionObject* object(int i) const override { return object_[i]; }
  void linearise(const Pose (&X_WB_end)[2], std::vector<MissedContact>& out) override;
  void findMissed(const Pose (&X_WB_end)[2], CheckRound round, std::vector<MissedContact>& out) override;
  double freeShare(const Pose (&X_WB_end)[2]) override;
  double freeShareOfPoints(const Pose (&X_WB_end)[2]) override;
  void endStep() override { is_of_this_step_ = false; }

 private:
  struct Placed;
  struct Motion;
  [[nodiscard]] bool read(const Pose (&X_WB_end)[2], Motion& motion) const;
  void measure(const PairView& start, Motion& motion) const;
  void relinearise(const Motion& motion, const Placed& at_start, const Relinearising& which,
                   std::vector<MissedContact>& out);
  void findOnWay(Motion& motion, const Placed& at_start, CheckRound round, std::vector<MissedContact>& out);
  void findAmongRefined(const Motion& motion, std::vector<Candidate>& missed) const;
  void findOverlaps(const Motion& motion, const PairView& pair, std::vector<Candidate>& found) const;
  void findAlongPath(const Motion& motion, std::vector<Candidate>& missed) const;
  bool refineAtStart(const Motion& motion, const PairView& at_start, Candidate& start, Candidate& end) const;
  [[nodiscard]] bool wasOutside(const Motion& motion, const PairView& at_start, const Candidate& start) const;
  [[nodiscard]] bool mayMissPoints(const Motion& motion, const PairView& at_start) const;
  [[nodiscard]] bool leavesCurve(const Motion& motion, const PairView& at_start, const Candidate& c) const;
  bool measureAtStart(const Motion& motion, const PairView& at_start, Candidate& start) const;
  void put(const Motion& motion, const Placed& at_start, const Candidate& start, const Candidate& end,
           std::vector<MissedContact>& out);
  void emit(const Motion& motion, std::vector<Candidate>& missed, std::vector<MissedContact>& out);

  PairState& state_;
  bool is_of_this_step_ = false;
  const btCollisionObject* object_[2] = {nullptr, nullptr};
  const btCollisionShape* shape_[2] = {nullptr, nullptr};
  const btCollisionShape* root_[2] = {nullptr, nullptr};  ///< shapes of the bodies; shape_ may be a child
  Pose X_BS_[2];
};

/// True if bullet::Solver calls this pair's check.
bool isCheckedBySolver(const PairView& pair, const PairState& state);

/// True if isCheckedBySolver() and nothing suggests that bullet::Solver will pass the pair's island to
/// Bullet's solver: no body has anisotropic friction, and no island was passed on before. The check then
/// finds contacts that arise because other bodies push this pair, so the selection need not have them. False
/// for sensors.
bool isSurelyChecked(const PairView& pair, const PairState& state);

/// True if no solver calls this pair's check: in a world that bullet::Solver does not solve, and for bodies
/// with linear or angular factors, or without inertia, which bullet::Solver passes to Bullet's solver. In the
/// first step of a world without tuneWorld() the solver is not known yet, and the result is true. False for
/// links of a btMultiBody and for anisotropic friction.
bool checksAlone(const PairView& pair, const PairState& state);

/// Runs the rounds of a step (solver/rigid/contact_loop.h) for one pair, if checksAlone(): solves the step
/// for the pair's two bodies with the contacts in its manifolds, adds the contacts that state.check finds
/// missing, and repeats until none is missing or the rounds are used up. The manifolds then hold distances
/// for which a solver with linear rows ends the step with the gaps that were found, less the contacts' rest
/// gaps.
///
/// The step is solved with gravity, the user's forces and the predicted pull of couplings. Other bodies and
/// joints are not known, so contacts that only they cause are missed. Bodies are not changed, nor are the
/// impulses of contacts that existed in the last step.
void addMissedAlone(btDispatcher& dispatcher, const PairView& pair, PairState& state);

}  // namespace vps::bullet
