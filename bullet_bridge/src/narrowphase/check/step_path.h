// SPDX-License-Identifier: BSD-3-Clause
// Chooses the time within a step at which the row of a contact is taken.
#pragma once

#include "narrowphase/candidates/contact_candidate.h"

class btCollisionObject;

namespace vps::bullet {

/// Motion of both bodies in a solved step.
///
/// A row of the solver is linear: it has one lever and one normal for the whole step. Lever and normal turn
/// during the step, and the contact's normal velocity changes with them, from s0 at the start to s1 at the
/// end (both as displacements). The row takes lever and normal at the time tau (as a share of the step) at
/// which that velocity is zero, so that the contact does no work:
///
///     tau = 1/2 + g0 / (s1 - s0),  at least 1/2
///
/// where g0 is the gap at the start, above the rest gap; a contact with load closes it. For a body that turns
/// about a corner (g0 = 0), tau is 1/2, the middle of the step. A rolling wheel touches at the place that is
/// lowest at the end, so tau is 1. The lever at the start would brake a rolling body; the lever at the end
/// would drive a body that turns about a corner.
///
/// A tau above 1 occurs for a corner that lands within the step after another corner carried the load; the
/// effective lever lies between both corners. Such a tau is used only if the bodies approach each other by
/// less than their weight moves them in a step, since a faster approach is an impact, which acts at the
/// corner; and only as far as the row still closes half of a gap, so that the rounds of the solver end.
/// Points of faces never use a tau above 1: the differences of their gaps from facet to facet would drive a
/// screw.
///
/// Both bodies' levers pass through one point of the world, so that angular momentum is conserved. The point
/// moves with the body that turns more easily, whose lever is then exact.
class StepPath {
 public:
  StepPath() = default;
  /// @param start, end  poses of the bodies' frames, whose origins are the centres of mass
  StepPath(const btCollisionObject* const (&objects)[2], const Pose (&start)[2], const Pose (&end)[2],
           double dt_s);

  /// Rows are taken at the end of the step from now on, where they are the exact derivatives of the gaps. If
  /// a body rotates far while other contacts hold it, a contact's push may open its gap by less than the
  /// rotation of its lever closes it, so that the contact ends deeper after a harder push. With exact
  /// derivatives the rounds of the solver converge.
  void settle() { is_settled_ = true; }
  [[nodiscard]] bool isSettled() const { return is_settled_; }
  /// The contact as a row of the solver, at the poses of the start and with its gap there.
  /// @param start, end  the same contact at both ends of the step
  [[nodiscard]] Candidate acting(const Candidate& start, const Candidate& end) const;
  /// True if the contact's normal velocity changes during the step, so that its row depends on the time at
  /// which it is taken.
  [[nodiscard]] bool bends(const Candidate& start, const Candidate& end) const;
  /// Gap at the end of the step as predicted by the contact's plane at the start.
  [[nodiscard]] double endGap_m(const Candidate& start) const {
    return start.distance_m + way_m({start.p_W, start.n_W});
  }

 private:
  struct Body {
    Vec3 center_W = Vec3::Zero(), way_W = Vec3::Zero(), turn = Vec3::Zero();
    Vec3 kick_W = Vec3::Zero();  ///< displacement in a step by gravity and other forces
    double inverse_mass = 0;     ///< 0 for a body that contact does not move
    Mat3 inverse_inertia_W = Mat3::Zero();
  };
  /// Point and normal of a contact.
  struct Row {
    Vec3 p_W, n_W;
  };
  [[nodiscard]] Row atEnd(const Candidate& end) const { return {end.p_W - common_way_W_, end.n_W}; }
  [[nodiscard]] double way_m(const Row& row) const;
  [[nodiscard]] double effect(const Row& of, const Row& on) const;
  [[nodiscard]] double timeOf(const Row& start, const Row& end, double closed_m, bool is_corner) const;

  Body body_[2];
  Vec3 common_way_W_ = Vec3::Zero();
  bool is_settled_ = false;
};

}  // namespace vps::bullet
