// SPDX-License-Identifier: BSD-3-Clause
// Points that press on each other in one pair of bodies, as the penalty method takes them.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "vps/pose.h"

class btCollisionObject;
class btPersistentManifold;

namespace vps::bullet {

struct Candidate;
struct Carry;
struct RelativeMotion;

/// A point of one side near the other's surface: a spring along the normal, and a bristle in the tangent
/// plane that bends until it slips. Both are anchored in the point, so friction holds without creep.
struct PenaltyPoint {
  std::uint64_t key = 0;       ///< side and id of the point, as Candidate::key()
  Vec3 p_W = Vec3::Zero();     ///< now
  Vec3 n_W = Vec3::Zero();     ///< unit, from body 1 to body 0
  double gap_m = 0;            ///< now, eased
  double k_N_per_m = 0;        ///< of the spring: stiffness per area, times area; of the bristle as well
  Vec3 bend_W = Vec3::Zero();  ///< of the bristle [m]: how far body 0 has gone against body 1
  double f_n_N = 0;            ///< normal force at the end of the last step solved
  double ease_m = 0;           ///< of an overlap the bodies were put into: not pressed out at once
};

/// A pair's points, ascending by key.
struct PenaltyPair {
  const btCollisionObject* object[2] = {nullptr, nullptr};
  bool is_of_manifold = false;   ///< points are in the order of its contacts
  Mat3 R_W1 = Mat3::Identity();  ///< body 1's orientation that bends are given at
  std::vector<PenaltyPoint> points;
  double mu = 0;
  double all_N = 0;   ///< normal force of all points
  double told_N = 0;  ///< normal force of the points that are contacts in a manifold
};

/// Renews a pair's points from candidates (ascending by key), carried from where they were found to now;
/// those that stay keep bend, force and ease.
/// @param stiffness_N_per_m3  of the candidates' area, the share of a side that counts half included
void renewPoints(PenaltyPair& pair, std::span<const Candidate> candidates, double stiffness_N_per_m3,
                 const RelativeMotion& motion, const Carry& carry);

/// A manifold of an island with compliant contacts.
struct PenaltyManifold {
  btPersistentManifold* manifold = nullptr;
  PenaltyPair* pair = nullptr;
};

/// The contacts of a manifold that is no VPS pair's, as springs of their own.
PenaltyPair penaltyPairOf(const btPersistentManifold& manifold, double dt_s);

/// Leaves impulses in the manifolds' contacts: their points' own, scaled so that each pair's add up to all of
/// it.
void leaveImpulses(std::span<const PenaltyManifold> manifolds, double dt_s);

/// Which pair a manifold stands for. Pairs come and go in any thread.
class PenaltyRegistry {
 public:
  void add(const btPersistentManifold* manifold, PenaltyPair* pair) {
    const std::lock_guard lock(mutex_);
    pairs_[manifold] = pair;
  }
  void remove(const PenaltyPair* pair) {
    const std::lock_guard lock(mutex_);
    std::erase_if(pairs_, [&](const auto& entry) { return entry.second == pair; });
  }
  /// Null: the manifold's own contacts are all there is.
  [[nodiscard]] PenaltyPair* of(const btPersistentManifold* manifold) const {
    const std::lock_guard lock(mutex_);
    const auto it = pairs_.find(manifold);
    return it == pairs_.end() ? nullptr : it->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<const btPersistentManifold*, PenaltyPair*> pairs_;
};

}  // namespace vps::bullet
