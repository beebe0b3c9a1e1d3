// SPDX-License-Identifier: BSD-3-Clause
#include "solver/penalty_pair.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>

#include "narrowphase/manifold_writer.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {
namespace {

/// A point that stands for no area: a steel corner of a millimetre. Assumed.
constexpr double kPointStiffness_N_per_m = 1e7;

Vec3 lateralImpulse(const btManifoldPoint& point) {
  return fromBt(point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
}

void setLateralImpulse(btManifoldPoint& point, const Vec3& impulse_Ns) {
  point.m_appliedImpulseLateral1 = point.m_lateralFrictionDir1.dot(toBt(impulse_Ns));
  point.m_appliedImpulseLateral2 = point.m_lateralFrictionDir2.dot(toBt(impulse_Ns));
}

/// The point of the pair that a manifold's contact was made of; null: none.
const PenaltyPoint* pointOf(const PenaltyPair& pair, const btManifoldPoint& contact, int index) {
  if (pair.is_of_manifold) return &pair.points[static_cast<std::size_t>(index)];
  const std::uint64_t key = keyOf(contact);
  const auto it = std::lower_bound(pair.points.begin(), pair.points.end(), key,
                                   [](const PenaltyPoint& p, std::uint64_t k) { return p.key < k; });
  return it != pair.points.end() && it->key == key ? &*it : nullptr;
}

}  // namespace

void renewPoints(PenaltyPair& pair, std::span<const Candidate> candidates, double stiffness_N_per_m3,
                 const RelativeMotion& motion, const Carry& carry) {
  constexpr double kMostEasing_m_s = 0.05;  // assumed: bodies put into each other separate gently
  const double easing_m = kMostEasing_m_s * motion.dt_s;
  const Mat3 R_W1 = fromBt(pair.object[1]->getWorldTransform().getBasis());
  const Mat3 turned = R_W1 * pair.R_W1.transpose();
  pair.R_W1 = R_W1;
  thread_local std::vector<PenaltyPoint> old;
  old.swap(pair.points);
  pair.points.resize(candidates.size());
  auto point_at = pair.points.begin();
  auto before = old.begin();
  for (Candidate c : candidates) {
    carry(c);
    PenaltyPoint& point = *point_at++ = {};
    point.key = c.key();
    point.p_W = c.p_W;
    point.n_W = c.n_W;
    point.k_N_per_m = stiffness_N_per_m3 * c.area_m2;
    double before_m = 0;  // a point that was not there has not been deeper
    while (before != old.end() && before->key < point.key) ++before;
    if (before != old.end() && before->key == point.key) {
      const Vec3 bend_W = turned * before->bend_W;
      point.bend_W = bend_W - point.n_W * point.n_W.dot(bend_W);
      point.f_n_N = before->f_n_N;
      before_m = std::min(0.0, before->gap_m);
      // What is given back is pressed out in a step, so no more than that may lie open.
      if (before->ease_m > 0) point.ease_m = std::max(before->ease_m - easing_m, -c.distance_m - easing_m);
    }
    // Deeper than the step's approach can bring it: the bodies were put into each other, or another surface
    // became the nearest.
    const double deeper_m = before_m - motion.contact_margin_m - c.distance_m;
    if (deeper_m > point.ease_m) {
      const double approach_m = std::max(0.0, -c.n_W.dot(motion.velocityAt(c.p_W)) * motion.dt_s) +
                                0.1 * motion.own_speed_m_s * motion.dt_s;
      point.ease_m = std::max(point.ease_m, deeper_m - approach_m);
    }
    point.ease_m = std::clamp(point.ease_m, 0.0, std::max(0.0, -c.distance_m));
    point.gap_m = c.distance_m + point.ease_m;
  }
}

PenaltyPair penaltyPairOf(const btPersistentManifold& manifold, double dt_s) {
  PenaltyPair pair;
  pair.is_of_manifold = true;
  pair.object[0] = manifold.getBody0();
  pair.object[1] = manifold.getBody1();
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& contact = manifold.getContactPoint(i);
    PenaltyPoint point;
    point.p_W = 0.5 * fromBt(contact.getPositionWorldOnA() + contact.getPositionWorldOnB());
    point.n_W = fromBt(contact.m_normalWorldOnB);
    point.gap_m = contact.getDistance();
    point.k_N_per_m = kPointStiffness_N_per_m;
    point.f_n_N = contact.m_appliedImpulse / dt_s;
    // The impulse was on body 0, against its way.
    point.bend_W = -lateralImpulse(contact) / (dt_s * point.k_N_per_m);
    pair.points.push_back(point);
    pair.mu = std::max<double>(pair.mu, contact.m_combinedFriction);
  }
  return pair;
}

void leaveImpulses(std::span<const PenaltyManifold> manifolds, double dt_s) {
  const auto forEachContact = [&](const auto& visit) {
    for (const auto& [manifold, pair] : manifolds)
      for (int i = 0; i < manifold->getNumContacts(); ++i)
        visit(*pair, manifold->getContactPoint(i), pointOf(*pair, manifold->getContactPoint(i), i));
  };
  for (const PenaltyManifold& m : manifolds) m.pair->told_N = 0;
  forEachContact([](PenaltyPair& pair, btManifoldPoint&, const PenaltyPoint* point) {
    if (point) pair.told_N += point->f_n_N;
  });
  forEachContact([dt_s](const PenaltyPair& pair, btManifoldPoint& contact, const PenaltyPoint* point) {
    const double scale = point && pair.told_N > 0 ? dt_s * pair.all_N / pair.told_N : 0;
    contact.m_appliedImpulse = toBt(point ? scale * point->f_n_N : 0);
    setLateralImpulse(contact, point ? Vec3(-scale * point->k_N_per_m * point->bend_W) : Vec3(Vec3::Zero()));
  });
}

}  // namespace vps::bullet
