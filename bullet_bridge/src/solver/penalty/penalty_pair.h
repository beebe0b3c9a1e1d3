// SPDX-License-Identifier: BSD-3-Clause
// The penalty points of one pair of bodies, and groups of neighbouring points that are solved as one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/pose.h"

class btCollisionObject;
class btPersistentManifold;

namespace vps::bullet {

/// A point of one side near the other side's surface: a spring along the normal and a bristle in the tangent
/// plane (vps/friction.h). Spring and bristle are fixed to the point, so friction holds without creep.
struct PenaltyPoint {
  std::uint64_t key = 0;       ///< contactKey() of the point
  Vec3 p_W = Vec3::Zero();     ///< now
  Vec3 n_W = Vec3::Zero();     ///< unit normal, from body 1 to body 0
  double gap_m = 0;            ///< present gap plus tolerated_m
  double k_N_per_m = 0;        ///< stiffness of spring and bristle: stiffness per area times area
  double mu = 0;               ///< coefficient of friction
  Vec3 bend_W = Vec3::Zero();  ///< deflection of the bristle [m]: displacement of body 0 against body 1
  double f_n_N = 0;            ///< normal force at the end of the last step solved
  bool is_leader = false;      ///< represented its PointGroup in the last step solved
  double tolerated_m = 0;      ///< part of an initial overlap that is not pressed out yet
};

/// The points of a pair, ascending by key.
struct PenaltyPair {
  const btCollisionObject* object[2] = {nullptr, nullptr};
  bool is_of_manifold = false;   ///< the points are in the order of a manifold's contacts
  Mat3 R_W1 = Mat3::Identity();  ///< orientation of body 1 to which bend_W of all points refers
  std::vector<PenaltyPoint> points;
  double total_N = 0;     ///< normal force of all points
  double manifold_N = 0;  ///< normal force of the points that are contacts in a manifold
};

/// A manifold of an island with penalty contacts.
struct PenaltyManifold {
  btPersistentManifold* manifold = nullptr;
  PenaltyPair* pair = nullptr;
};

/// Converts the contacts of a manifold without VPS contact to penalty points.
PenaltyPair penaltyPairOf(const btPersistentManifold& manifold, double dt_s);

/// Writes the points' impulses into the manifolds' contacts, scaled so that each pair's contacts add up to
/// the impulse of all its points.
void writeImpulses(std::span<const PenaltyManifold> manifolds, double dt_s);

/// The points [first, end) of a pair, solved as the point `leader` with the stiffness of all.
struct PointGroup {
  std::uint32_t leader = 0, first = 0, end = 0;
  double k_N_per_m = 0;
  double f_n_N = 0;  ///< sum of the forces at the end of the last step
};

/// Groups of up to 2^level points with neighbouring ids, which are neighbours in space (PointShell), and with
/// normals within 45 degrees and the same friction. The leader is the deepest point, or the last step's
/// leader if it is not clearly less deep: a new leader would hold friction at another place, and the part
/// would creep. At level 0, and for contacts of a manifold, each point is a group. O(points).
void groupPoints(const PenaltyPair& pair, int level, std::vector<PointGroup>& groups);

/// Greatest level. At this level a group is as large as an eighth of a face of a cube with 20,000 points.
inline constexpr int kCoarsestLevel = 8;

/// Lowest level at which the pairs have at most `limit` groups, at most kCoarsestLevel; 0 for a limit of 0.
/// O(points) per level.
int levelFor(std::span<const PenaltyPair* const> pairs, std::size_t limit);

}  // namespace vps::bullet
