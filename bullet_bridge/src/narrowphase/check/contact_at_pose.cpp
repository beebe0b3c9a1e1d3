// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/contact_at_pose.h"

#include <algorithm>
#include <cmath>

#include "narrowphase/selection/contact_selection.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// The points of a contact on both bodies.
void pointsOf(const Candidate& c, Vec3 (&on)[2]) {
  on[c.side] = c.p_W;
  on[1 - c.side] = c.p_W - (c.side == 0 ? 1 : -1) * c.distance_m * c.n_W;
}

// True if the position `at` on an edge, as a fraction of the edge's length, lies between the edge's ends.
// Where a curved edge continues in another segment, the crossing may lie past the joint, as findCrossings()
// allows.
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

bool isInside(const Vec3& p_W, const SideView& other, double near_m, double tolerated_m) {
  if (!other.shape || other.shape->models().surfaces.empty()) return true;
  for (const Surface& surface : other.shape->models().surfaces) {
    if (surface.sheet) return true;
    const Vec3 p = (other.X_WM * surface.X_MP).inverse() * p_W;
    if (surface.distance->signedDistance(p, near_m) < -tolerated_m) return true;
  }
  return false;
}

bool refineAt(const PairView& pair, double max_m, const Settings& settings, Candidate& c) {
  thread_local std::vector<Candidate> one;
  one.assign(1, c);
  one[0].distance_m = -max_m;
  refineAll(pair, RelativeMotion(), settings, one);
  c = one[0];
  return std::abs(c.distance_m) < max_m;
}

bool areBothCurved(const PairView& pair, PairState& state) {
  const auto hasCurves = [](const Shape* shape) {
    if (!shape) return true;
    const FeatureSet& features = shape->features();
    for (std::uint32_t i = 0; i < features.facets().size(); ++i)
      if (features.isCurved(i)) return true;
    return false;
  };
  if (!state.are_both_curved) state.are_both_curved = hasCurves(pair.shape[0]) && hasCurves(pair.shape[1]);
  return *state.are_both_curved;
}

void findThere(const PairView& there, const PairState& state, bool only_loaded, std::vector<Candidate>& now,
               std::vector<Candidate>& ends) {
  const Settings& settings = state.context->settings;
  now.clear();
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const Candidate& c = state.contacts[k];
    if (c.isCrossing() || !there.shape[c.side]) continue;
    if (only_loaded) {
      const btManifoldPoint* point = state.writer->find(c.key(), k);
      if (!point || !(point->m_appliedImpulse > 0)) continue;
    }
    now.push_back(c);
  }
  ends = now;
  for (Candidate& end : ends) {
    end.p_W = there.side(end.side).X_WM * there.shape[end.side]->models().shell->points[end.id];
    end.n_W.setZero();  // remains zero if the point is out of reach at the end
  }
  RelativeMotion still;
  still.contact_margin_m = settings.contact_margin_m;
  refineAll(there, still, settings, ends);
}

}  // namespace vps::bullet
