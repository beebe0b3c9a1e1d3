// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/step_path.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

StepPath::StepPath(const btCollisionObject* const (&objects)[2], const Pose (&start)[2], const Pose (&end)[2],
                   double dt_s) {
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    Body& b = body_[i];
    b.center_W = start[i].p;
    b.way_W = end[i].p - start[i].p;
    b.turn = rotationVector(end[i].R * start[i].R.transpose());
    const btRigidBody* rigid = btRigidBody::upcast(objects[i]);
    if (!rigid || rigid->isStaticOrKinematicObject()) continue;
    b.inverse_mass = rigid->getInvMass();
    const Vec3 inverse = fromBt(rigid->getInvInertiaDiagLocal());
    b.inverse_inertia_W = start[i].R * inverse.asDiagonal() * start[i].R.transpose();
    b.kick_W = dt_s * dt_s * b.inverse_mass * fromBt(rigid->getTotalForce());
    common_way_W_ += inverse.sum() * b.way_W;
    sum += inverse.sum();
  }
  if (sum > 0) common_way_W_ /= sum;
}

// Displacement of the bodies from each other along a row in the step.
double StepPath::way_m(const Row& row) const {
  const auto wayOf = [&](const Body& b) { return Vec3(b.way_W + b.turn.cross(row.p_W - b.center_W)); };
  return row.n_W.dot(wayOf(body_[0]) - wayOf(body_[1]));
}

// Velocity along row `of` caused by a unit impulse along row `on`.
double StepPath::effect(const Row& of, const Row& on) const {
  double sum = 0;
  for (const Body& b : body_) {
    const Vec3 turn = b.inverse_inertia_W * (of.p_W - b.center_W).cross(of.n_W);
    sum += b.inverse_mass * of.n_W.dot(on.n_W) + turn.dot((on.p_W - b.center_W).cross(on.n_W));
  }
  return sum;
}

namespace {

// Smaller displacements, and smaller changes of them during the step, count as zero. The value is the
// rounding error of the difference of two single-precision positions a decimetre from the centre.
constexpr double kKnown_m = 10 * kRounding_m;

template <typename Row>
Row between(const Row& start, const Row& end, double tau) {
  return {(1 - tau) * start.p_W + tau * end.p_W, ((1 - tau) * start.n_W + tau * end.n_W).normalized()};
}

}  // namespace

double StepPath::timeOf(const Row& start, const Row& end, double closed_m, bool is_corner) const {
  const double bend_m = std::max(way_m(end) - way_m(start), kKnown_m);
  double tau = std::max(0.5, 0.5 + closed_m / bend_m);
  if (tau <= 1) return tau;
  if (!(bend_m > kKnown_m) || !is_corner) return 1;
  const double kick_m = -end.n_W.dot(body_[0].kick_W - body_[1].kick_W);
  if (!(closed_m < kick_m)) return 1;
  const double own = effect(end, end);
  for (int k = 0; k < kMostRounds; ++k, tau = 0.5 * (1 + tau))
    if (effect(between(start, end, tau), end) >= 0.5 * own) return tau;
  return 1;
}

Candidate StepPath::acting(const Candidate& start, const Candidate& end) const {
  const Row from{start.p_W, start.n_W}, to = atEnd(end);
  const bool is_corner = end.plane_of != Candidate::kBetween && end.isCrossing();
  const Row row =
      is_settled_ ? to : between(from, to, timeOf(from, to, start.distance_m - start.rest_m, is_corner));
  Candidate acting = end;
  acting.p_W = row.p_W;
  acting.n_W = row.n_W;
  acting.distance_m = start.distance_m;
  return acting;
}

bool StepPath::bends(const Candidate& start, const Candidate& end) const {
  return std::abs(way_m(atEnd(end)) - way_m({start.p_W, start.n_W})) > kKnown_m;
}

}  // namespace vps::bullet
