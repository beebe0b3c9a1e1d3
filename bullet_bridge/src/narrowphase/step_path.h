// SPDX-License-Identifier: BSD-3-Clause
// Where a contact acts in a step: the row of a contact whose lever and normal turn on the way.
#pragma once

#include "narrowphase/contact_candidate.h"

class btCollisionObject;

namespace vps::bullet::inline v0 {

/// The way of both bodies in a solved step.
///
/// A row of the solver is linear: one lever and one normal for the whole step. On the way they turn, and the
/// contact's normal velocity changes with them, from s0 at the start to s1 at the end (here as displacements).
/// The row takes them at the time at which that velocity is zero, so that the contact does no work:
///
///     tau = 1/2 + g0 / (s1 - s0),  within [1/2, 1]
///
/// where g0 is the gap at the start (above the one at which it rests), which a contact with load closes. A body
/// that turns about a corner (g0 = 0) has it in the middle of the step. A wheel that rolls meets the
/// place that is lowest at the end, tau = 1. With the lever of the start the contact would brake what rolls,
/// with that of the end it would drive what turns about a corner.
///
/// Both bodies' levers pass through one point of the world, so that angular momentum is kept. It goes with the
/// body that turns more easily, whose lever is then exact.
class StepPath {
 public:
  StepPath() = default;
  /// @param start, end  of the bodies' frames, which are at their centres
  StepPath(const btCollisionObject* const (&objects)[2], const Pose (&start)[2], const Pose (&end)[2]);

  /// The contact as a row of the solver: where the bodies are at the start, with the gap that it has there.
  /// @param start, end  the same contact at both ends of the step
  [[nodiscard]] Candidate acting(const Candidate& start, const Candidate& end) const;

 private:
  [[nodiscard]] double normalWay_m(const Vec3& p_W, const Vec3& n_W) const;

  Vec3 center_W_[2] = {Vec3::Zero(), Vec3::Zero()}, way_W_[2] = {Vec3::Zero(), Vec3::Zero()},
       turn_[2] = {Vec3::Zero(), Vec3::Zero()};
  Vec3 common_way_W_ = Vec3::Zero();
};

}  // namespace vps::bullet::inline v0
