// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/penalty_points.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>

#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

void updatePenaltyPoints(PenaltyPair& pair, std::span<const Candidate> candidates,
                         const PairMaterial& material, double usual_N_per_m3, int sides,
                         const RelativeMotion& motion, const CandidateMotion& moved) {
  const double separation_m = kSeparation_m_s * motion.dt_s;
  const Mat3 R_W1 = fromBt(pair.object[1]->getWorldTransform().getBasis());
  const Mat3 turned = R_W1 * pair.R_W1.transpose();
  pair.R_W1 = R_W1;
  thread_local std::vector<PenaltyPoint> old;
  old.swap(pair.points);
  pair.points.resize(candidates.size());
  auto point_at = pair.points.begin();
  auto before = old.begin();
  for (Candidate c : candidates) {
    moved(c);
    PenaltyPoint& point = *point_at++ = {};
    point.key = c.key();
    point.p_W = c.p_W;
    point.n_W = c.n_W;
    point.k_N_per_m = material.stiffness_N_per_m3(c, usual_N_per_m3) / sides * c.area_m2;
    point.mu = material.friction(c);
    double before_m = 0;  // a new point has had no depth
    while (before != old.end() && before->key < point.key) ++before;
    if (before != old.end() && before->key == point.key) {
      const Vec3 bend_W = turned * before->bend_W;
      point.bend_W = bend_W - point.n_W * point.n_W.dot(bend_W);
      point.f_n_N = before->f_n_N;
      point.is_leader = before->is_leader;
      before_m = std::min(0.0, before->gap_m);
      // The share that is no longer tolerated is pressed out within the step: at most separation_m of it.
      if (before->tolerated_m > 0)
        point.tolerated_m = std::max(before->tolerated_m - separation_m, -c.distance_m - separation_m);
    }
    // The point is deeper than the approach in the step explains: the bodies were placed into each other, or
    // another surface became the nearest.
    const double deeper_m = before_m - motion.contact_margin_m - c.distance_m;
    if (deeper_m > point.tolerated_m) {
      const double approach_m = std::max(0.0, -c.n_W.dot(motion.velocityAt(c.p_W)) * motion.dt_s) +
                                0.1 * motion.own_speed_m_s * motion.dt_s;
      point.tolerated_m = std::max(point.tolerated_m, deeper_m - approach_m);
    }
    point.tolerated_m = std::clamp(point.tolerated_m, 0.0, std::max(0.0, -c.distance_m));
    point.gap_m = c.distance_m + point.tolerated_m;
  }
}

}  // namespace vps::bullet
