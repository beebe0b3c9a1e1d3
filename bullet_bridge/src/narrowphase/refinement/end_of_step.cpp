// SPDX-License-Identifier: BSD-3-Clause
// Gaps at the end of the step. A contact plane is first-order in the motion. On the facets of a curved face,
// and where one face continues smoothly in another, a point that slides by a facet or more has another gap
// than its plane predicts. The part would then sink or drop by up to the facets' height in each step, and
// the next step's impact would take that energy.
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <cmath>

#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/selection/contact_selection.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// Displacement in free motion, with the share RelativeMotion::pull_share of the couplings' pull.
Pose freeWay(const btCollisionObject& object, const RelativeMotion& motion) {
  const double dt_s = motion.dt_s;
  Twist V = predictedVelocity(object, dt_s);
  if (motion.pull_share < 1) {
    const Twist own = predictedVelocity(object, dt_s, false);
    V = {own.w + motion.pull_share * (V.w - own.w), own.v + motion.pull_share * (V.v - own.v)};
  }
  return displacement(object, V, dt_s);
}

// True for a contact whose point moves along its plane. Other points meet the plane, so their position at the
// end of free motion is meaningless.
bool slides(const Candidate& c, const Vec3& way_W, double contact_margin_m) {
  return !c.isCrossing() && c.plane_of != Candidate::kBetween && way_W.norm() > contact_margin_m &&
         std::abs(c.n_W.dot(way_W)) < kSinGrazing * way_W.norm();
}

// True if the point is, at the end, on the same curved face or on a face that continues it smoothly. On a
// flat face the plane is exact already.
bool isOnCurve(const Candidate& now, const Candidate& end, const Pose (&way)[2], double contact_margin_m) {
  return end.plane_of == now.plane_of && (end.n_W - way[now.plane_of].R * now.n_W).norm() > kNoDirection &&
         end.n_W.dot(now.n_W) > kCosSameFace &&
         std::abs(end.distance_m) < std::abs(now.distance_m) + contact_margin_m;
}

}  // namespace

void measureAtEnd(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                  std::vector<Candidate>& candidates) {
  if (!settings.use_surfaces || !pair.shape[0] || !pair.shape[1]) return;
  Pose way[2];
  for (int i = 0; i < 2; ++i) way[i] = freeWay(*pair.wrapper[i]->getCollisionObject(), motion);
  RelativeMotion still;
  still.contact_margin_m = motion.contact_margin_m;
  thread_local std::vector<Candidate> ends;
  thread_local std::vector<std::size_t> sliding;
  for (int i = 0; i < 2; ++i) {
    if (!queriesPoints(pair, i, settings.sides)) continue;
    SideView side = pair.side(i), other = pair.side(1 - i);
    side.X_WM = way[i] * side.X_WM;
    other.X_WM = way[1 - i] * other.X_WM;
    ends.clear();
    sliding.clear();
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const Candidate& c = candidates[k];
      if (c.side != i || !slides(c, motion.dt_s * motion.velocityAt(c.p_W), motion.contact_margin_m))
        continue;
      sliding.push_back(k);
      ends.push_back(c);
      ends.back().p_W = side.X_WM * pair.shape[i]->models().shell->points[c.id];
      ends.back().n_W.setZero();  // stays zero if the point is out of reach at the end
    }
    if (ends.empty()) continue;
    refine(ends, side, other, *pair.wrapper[1 - i]->getCollisionShape(), still,
           queriesPoints(pair, 1 - i, settings.sides));
    for (std::size_t k = 0; k < ends.size(); ++k) {
      Candidate& c = candidates[sliding[k]];
      // The present normal remains, since the contact acts now.
      if (isOnCurve(c, ends[k], way, motion.contact_margin_m))
        c.distance_m = ends[k].distance_m - c.n_W.dot(motion.dt_s * motion.velocityAt(c.p_W));
    }
  }
}

}  // namespace vps::bullet
