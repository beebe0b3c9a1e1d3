// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/step_path.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {
namespace {

// Trace of the inverse inertia; 0 for what contact does not turn.
double easeOfTurning(const btCollisionObject& object) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || body->isStaticOrKinematicObject()) return 0;
  return fromBt(body->getInvInertiaDiagLocal()).sum();
}

}  // namespace

StepPath::StepPath(const btCollisionObject* const (&objects)[2], const Pose (&start)[2],
                   const Pose (&end)[2]) {
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    center_W_[i] = start[i].p;
    way_W_[i] = end[i].p - start[i].p;
    turn_[i] = rotationVector(end[i].R * start[i].R.transpose());
    const double ease = easeOfTurning(*objects[i]);
    common_way_W_ += ease * way_W_[i];
    sum += ease;
  }
  if (sum > 0) common_way_W_ /= sum;
}

// How far the bodies part along n in the step, by a row with the lever of p.
double StepPath::normalWay_m(const Vec3& p_W, const Vec3& n_W) const {
  const auto wayOf = [&](int i) { return Vec3(way_W_[i] + turn_[i].cross(p_W - center_W_[i])); };
  return n_W.dot(wayOf(0) - wayOf(1));
}

Candidate StepPath::acting(const Candidate& start, const Candidate& end) const {
  const Vec3 p1_W = end.p_W - common_way_W_;
  const double bend_m = normalWay_m(p1_W, end.n_W) - normalWay_m(start.p_W, start.n_W);
  const double closed_m = start.distance_m - start.rest_m;
  double tau = closed_m > 0 ? 1 : 0.5;
  if (bend_m > 0) tau = std::clamp(0.5 + closed_m / bend_m, 0.5, 1.0);
  Candidate acting = end;
  acting.p_W = (1 - tau) * start.p_W + tau * p1_W;
  acting.n_W = ((1 - tau) * start.n_W + tau * end.n_W).normalized();
  acting.distance_m = start.distance_m;
  return acting;
}

}  // namespace vps::bullet::inline v0
