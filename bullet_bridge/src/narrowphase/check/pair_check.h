// SPDX-License-Identifier: BSD-3-Clause
// Checks whether the bodies of a pair overlap at the end of a solved step, and adds the contacts that
// prevent it.
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

/// A pair's check of the solved step, in four stages, each only where the one before cannot exclude an
/// overlap:
///
///   1. Bounds of the motion: how far any point moved relative to the other body, and how far from where it
///   was
///      predicted.
///   2. The points that were refined for the step's selection, including those that were left out of it: the
///      gaps of their planes at the end of the step, exactly. (The solver's are to first order in the
///      motion.)
///   3. The exact motion of corners, sharp edges and facets (feature_check.h).
///   4. A query of all points at the end of the step, and of a fast body at places on its way; and of the
///      vertices of facets that protrude from the points on these (facet_corners.h). Curved faces are looked
///      at between their points as well (sampling_error.h).
///
/// Bodies that turn against each other by more than kContactTurn_rad are checked in stages 3 and 4 only:
/// planes are not carried along then, and a point's gaps before the step and after it are each measured where
/// it is.
///
/// A contact that is missing gets the plane through which the point entered.
///
/// The reverse is looked at as well: a contact that carries load although it ends the step apart. Its plane
/// is to first order in the motion, and the step turned it away. It gets the plane that it has at the end.
class PairCheck final : public StepCheck {
 public:
  explicit PairCheck(PairState& state) : state_(state) {}

  /// To be called in each step before it is solved, since Bullet's wrappers live for one call.
  void setBodies(const PairView& pair);
  /// False in a pair that Bullet did not process in this step: its shapes may be others by now, or gone.
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
  const btCollisionShape* root_[2] = {nullptr, nullptr};  ///< of the bodies; shape_ may be a child
  Pose X_BS_[2];
};

/// True if bullet::Solver asks the pair for its missing contacts.
bool isCheckedBySolver(const PairView& pair, const PairState& state);

/// True if, moreover, nothing suggests that the solver may leave the pair's island to Bullet's own: no body
/// with anisotropic friction, and no island that was left to it before. Contacts that arise because other
/// bodies push this pair are found then, so that the first guess need not have them. False for sensors.
bool isSurelyChecked(const PairView& pair, const PairState& state);

/// True if no solver asks the pair for its missing contacts: in a world that bullet::Solver does not solve,
/// and for bodies with linear or angular factors, or without inertia, which it passes to Bullet's. In the
/// first step of a world that tuneWorld() has not seen the solver is not known yet. False for links of a
/// btMultiBody and for anisotropic friction.
bool checksAlone(const PairView& pair, const PairState& state);

/// Where checksAlone(), solves the step for the pair's two bodies alone, with the contacts in its manifolds,
/// asks state.check which contacts the solution lacks, and adds them to the manifolds, until none is missing
/// or the rounds are used up. The distances in the manifolds are then those for which a solver whose rows are
/// linear ends the step with the gaps that were found, less the contacts' rest gaps.
///
/// Gravity, the user's forces and the pull of couplings act as they were predicted. Other bodies and joints
/// are not known, so that a contact is missed to which only these lead. Bodies are left as they were, and so
/// are the impulses of all contacts that the last step had.
void addMissedAlone(btDispatcher& dispatcher, const PairView& pair, PairState& state);

}  // namespace vps::bullet
