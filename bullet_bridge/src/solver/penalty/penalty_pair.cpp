// SPDX-License-Identifier: BSD-3-Clause
#include "solver/penalty/penalty_pair.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>

#include "solver/contact_key.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

/// Stiffness of a point without an area: that of a steel corner of a millimetre. Assumed.
constexpr double kPointStiffness_N_per_m = 1e7;

Vec3 lateralImpulse(const btManifoldPoint& point) {
  return fromBt(point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
}

void setLateralImpulse(btManifoldPoint& point, const Vec3& impulse_Ns) {
  point.m_appliedImpulseLateral1 = point.m_lateralFrictionDir1.dot(toBt(impulse_Ns));
  point.m_appliedImpulseLateral2 = point.m_lateralFrictionDir2.dot(toBt(impulse_Ns));
}

/// The pair's point from which a manifold's contact was made; null if there is none.
const PenaltyPoint* pointOf(const PenaltyPair& pair, const btManifoldPoint& contact, int index) {
  if (pair.is_of_manifold) return &pair.points[static_cast<std::size_t>(index)];
  const std::uint64_t key = keyOf(contact);
  const auto it = std::lower_bound(pair.points.begin(), pair.points.end(), key,
                                   [](const PenaltyPoint& p, std::uint64_t k) { return p.key < k; });
  return it != pair.points.end() && it->key == key ? &*it : nullptr;
}

}  // namespace

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
    // The impulse acted on body 0, opposite to its displacement.
    point.bend_W = -lateralImpulse(contact) / (dt_s * point.k_N_per_m);
    point.mu = contact.m_combinedFriction;
    pair.points.push_back(point);
  }
  return pair;
}

void writeImpulses(std::span<const PenaltyManifold> manifolds, double dt_s) {
  const auto forEachContact = [&](const auto& visit) {
    for (const auto& [manifold, pair] : manifolds)
      for (int i = 0; i < manifold->getNumContacts(); ++i)
        visit(*pair, manifold->getContactPoint(i), pointOf(*pair, manifold->getContactPoint(i), i));
  };
  for (const PenaltyManifold& m : manifolds) m.pair->manifold_N = 0;
  forEachContact([](PenaltyPair& pair, btManifoldPoint&, const PenaltyPoint* point) {
    if (point) pair.manifold_N += point->f_n_N;
  });
  forEachContact([dt_s](const PenaltyPair& pair, btManifoldPoint& contact, const PenaltyPoint* point) {
    const double scale = point && pair.manifold_N > 0 ? dt_s * pair.total_N / pair.manifold_N : 0;
    contact.m_appliedImpulse = toBt(point ? scale * point->f_n_N : 0);
    setLateralImpulse(contact, point ? Vec3(-scale * point->k_N_per_m * point->bend_W) : Vec3(Vec3::Zero()));
  });
}

namespace {

double leadGap_m(const PenaltyPoint& p) {
  return p.is_leader ? p.gap_m - kSameGap_m : p.gap_m;
}

/// Calls visit(first, end) for each group.
template <typename Visit>
void forEachGroup(const PenaltyPair& pair, int level, const Visit& visit) {
  const std::vector<PenaltyPoint>& points = pair.points;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first + 1;
    if (!pair.is_of_manifold && level > 0)
      while (end < points.size() && points[end].key >> level == points[first].key >> level &&
             points[end].mu == points[first].mu && points[end].n_W.dot(points[first].n_W) > kCosAlike)
        ++end;
    visit(first, end);
    first = end;
  }
}

}  // namespace

void groupPoints(const PenaltyPair& pair, int level, std::vector<PointGroup>& groups) {
  groups.clear();
  forEachGroup(pair, level, [&](std::size_t first, std::size_t end) {
    PointGroup group{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(end)};
    for (std::size_t i = first; i < end; ++i) {
      group.k_N_per_m += pair.points[i].k_N_per_m;
      group.f_n_N += pair.points[i].f_n_N;
      if (leadGap_m(pair.points[i]) < leadGap_m(pair.points[group.leader]))
        group.leader = static_cast<std::uint32_t>(i);
    }
    groups.push_back(group);
  });
}

int levelFor(std::span<const PenaltyPair* const> pairs, std::size_t limit) {
  if (limit == 0) return 0;
  for (int level = 0; level < kCoarsestLevel; ++level) {
    std::size_t count = 0;
    for (const PenaltyPair* pair : pairs)
      forEachGroup(*pair, level, [&](std::size_t, std::size_t) { ++count; });
    if (count <= limit) return level;
  }
  return kCoarsestLevel;
}

}  // namespace vps::bullet
