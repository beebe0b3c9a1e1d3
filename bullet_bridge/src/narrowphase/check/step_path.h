// SPDX-License-Identifier: BSD-3-Clause
// Where a contact acts in a step: the row of a contact whose lever and normal turn on the way.
#pragma once

#include "narrowphase/candidates/contact_candidate.h"

class btCollisionObject;

namespace vps::bullet {

/// The way of both bodies in a solved step.
///
/// A row of the solver is linear: one lever and one normal for the whole step. On the way they turn, and the
/// contact's normal velocity changes with them, from s0 at the start to s1 at the end (here as
/// displacements). The row takes them at the time at which that velocity is zero, so that the contact does no
/// work:
///
///     tau = 1/2 + g0 / (s1 - s0),  at least 1/2
///
/// where g0 is the gap at the start (above the one at which it rests), which a contact with load closes. A
/// body that turns about a corner (g0 = 0) has it in the middle of the step. A wheel that rolls meets the
/// place that is lowest at the end, tau = 1. With the lever of the start the contact would brake what rolls,
/// with that of the end it would drive what turns about a corner.
///
/// A greater tau than 1 belongs to a corner that lands within the step, before which another one carried the
/// load: the lever of both together lies between them. It is taken where the bodies approach each other by
/// less than their weight moves them in a step; what comes faster is an impact, which acts at the corner. And
/// it is taken only as far as the row still closes half of a gap, so that the rounds of the solver end.
/// Points of faces have none: what their gaps differ by from facet to facet would drive a screw.
///
/// Both bodies' levers pass through one point of the world, so that angular momentum is kept. It goes with
/// the body that turns more easily, whose lever is then exact.
class StepPath {
 public:
  StepPath() = default;
  /// @param start, end  of the bodies' frames, which are at their centres
  StepPath(const btCollisionObject* const (&objects)[2], const Pose (&start)[2], const Pose (&end)[2],
           double dt_s);

  /// From now on rows are taken at the end of the step: they are the gaps' own derivatives. In a far turn,
  /// where others hold a body so that a contact's push hardly opens its gap, the turn of their levers may
  /// close it by more than that: pushed ever harder, it then ends ever deeper. With derivatives rounds
  /// converge.
  void settle() { is_settled_ = true; }
  [[nodiscard]] bool isSettled() const { return is_settled_; }
  /// The contact as a row of the solver: where the bodies are at the start, with the gap that it has there.
  /// @param start, end  the same contact at both ends of the step
  [[nodiscard]] Candidate acting(const Candidate& start, const Candidate& end) const;
  /// True if the contact's normal velocity changes on the way, so that it matters where its row is taken.
  [[nodiscard]] bool bends(const Candidate& start, const Candidate& end) const;
  /// The gap at the end of the step that the contact's plane at the start tells.
  [[nodiscard]] double endGap_m(const Candidate& start) const {
    return start.distance_m + way_m({start.p_W, start.n_W});
  }

 private:
  struct Body {
    Vec3 center_W = Vec3::Zero(), way_W = Vec3::Zero(), turn = Vec3::Zero();
    Vec3 kick_W = Vec3::Zero();  ///< how far gravity and other forces move it in a step
    double inverse_mass = 0;     ///< 0: contact does not move it
    Mat3 inverse_inertia_W = Mat3::Zero();
  };
  /// A contact's lever and normal.
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
