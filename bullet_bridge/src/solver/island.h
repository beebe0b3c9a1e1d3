// SPDX-License-Identifier: BSD-3-Clause
// The bodies of one of Bullet's simulation islands during a step: mass, drive and velocity.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <unordered_map>
#include <vector>

#include "vps/pose.h"

class btCollisionObject;
class btRigidBody;

namespace vps::bullet::inline v0 {

using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< angular, then linear; in W
using Mat6 = Eigen::Matrix<double, 6, 6>;

inline Vec6 stacked(const Vec3& w, const Vec3& v) {
  Vec6 u;
  u << w, v;
  return u;
}

/// A dynamic body; twists are about its centre. Its velocity u solves
/// effective_mass u = momentum + coupling_impulse + the contacts' impulses.
struct IslandBody {
  btRigidBody* rigid = nullptr;
  double reach_m = 0;  ///< greatest distance of its points from its centre
  Mat6 mass = Mat6::Zero();
  Vec6 momentum = Vec6::Zero();        ///< mass times the velocity with external forces
  Mat6 effective_mass = Mat6::Zero();  ///< mass plus the implicit part of its couplings
  Mat6 effective_inverse = Mat6::Zero();
  Vec6 coupling_impulse = Vec6::Zero();  ///< constant part of its couplings
  Vec6 u = Vec6::Zero();                 ///< initially that of the last step
};

/// Result of an iterative solution of the island.
struct SolveOutcome {
  int steps = 0;
  bool is_converged = false;
};

class Island {
 public:
  void clear();
  void add(btRigidBody& rigid, double dt_s);
  /// -1: contact does not move it.
  [[nodiscard]] int indexOf(const btCollisionObject* object) const;
  /// Velocity of a body that is not in the island but moves (kinematic), about its origin.
  [[nodiscard]] static Vec6 fixedVelocity(const btCollisionObject* object);
  /// Where a body's frame is at the end of the step: moved by `push`, then by its velocity, as Bullet does. A
  /// kinematic body goes on at its velocity.
  /// @param push  velocities that change positions only, one for each body; may be empty
  [[nodiscard]] Pose endPose(const btCollisionObject* object, std::span<const Vec6> push, double dt_s) const;
  void writeVelocities() const;
  void readVelocities(std::vector<Vec6>& u) const;
  /// Greatest speed of any point at these twists, one for each body [m/s]; infinite if one is not finite.
  [[nodiscard]] double topSpeed(std::span<const Vec6> twists) const;

  std::vector<IslandBody> bodies;

 private:
  std::unordered_map<const btCollisionObject*, int> index_;
};

}  // namespace vps::bullet::inline v0
