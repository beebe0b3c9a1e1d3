// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/carried_contact.h"

#include <algorithm>
#include <cmath>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// The points of a contact on both bodies.
void pointsOf(const Candidate& c, Vec3 (&on)[2]) {
  on[c.side] = c.p_W;
  on[1 - c.side] = c.p_W - (c.side == 0 ? 1 : -1) * c.distance_m * c.n_W;
}

// True if a place on an edge, as a share of its length, is not beyond its end. Where a curved edge goes on in
// another segment, a crossing may lie past the joint, as findCrossings() allows.
bool isOn(const EdgeSegment& s, double at, double gap_m) {
  const double past = kTanPastEnd * std::abs(gap_m) / (s.to - s.from).norm();
  return at >= (s.ends[0] ? 0 : -past) && at <= 1 + (s.ends[1] ? 0 : past);
}

}  // namespace

Vec3 Displacement::normal(const Candidate& c) const {
  if (c.plane_of != Candidate::kBetween) return D[c.plane_of].R * c.n_W;
  return (D[0].R * c.n_W + D[1].R * c.n_W).normalized();
}

Candidate Displacement::moved(const Candidate& c) const {
  Vec3 on[2];
  pointsOf(c, on);
  for (int i = 0; i < 2; ++i) on[i] = D[i] * on[i];
  Candidate to = c;
  to.n_W = normal(c);
  to.p_W = on[c.side];
  to.distance_m = to.n_W.dot(on[0] - on[1]);
  return to;
}

bool crossAt(Candidate& c, const SideView& body0, const SideView& body1) {
  const EdgeSegment &s0 = body0.shape->edges().segments()[c.id],
                    &s1 = body1.shape->edges().segments()[c.crossed - 1];
  const Vec3 from0 = body0.X_WM * s0.from, from1 = body1.X_WM * s1.from;
  const Vec3 d0 = body0.X_WM.R * (s0.to - s0.from), d1 = body1.X_WM.R * (s1.to - s1.from);
  Vec3 n = d0.cross(d1);
  const double square = n.squaredNorm();
  if (!(square > kSinParallel * kSinParallel * d0.squaredNorm() * d1.squaredNorm())) return false;
  const Vec3 r = from1 - from0;
  const double at0 = r.cross(d1).dot(n) / square, at1 = r.cross(d0).dot(n) / square;
  n /= std::sqrt(square);
  if (n.dot(c.n_W) < 0) n = -n;
  c.p_W = from0 + at0 * d0;
  c.n_W = n;
  c.distance_m = n.dot(c.p_W - (from1 + at1 * d1));
  return isOn(s0, at0, c.distance_m) && isOn(s1, at1, c.distance_m);
}

double overlapOf(Candidate c, const PairView& pair) {
  if (c.isCrossing() && !crossAt(c, pair.side(0), pair.side(1))) return 0;
  return std::min(0.0, c.distance_m);
}

}  // namespace vps::bullet
