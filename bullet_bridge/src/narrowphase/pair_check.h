// SPDX-License-Identifier: BSD-3-Clause
// Looks whether a solved step lets the bodies of a pair overlap, and with which contacts it would not.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <vector>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/feature_check.h"
#include "narrowphase/pair_state.h"
#include "narrowphase/pair_view.h"
#include "solver/step_check.h"

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

}  // namespace vps::bullet
