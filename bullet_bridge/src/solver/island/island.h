// SPDX-License-Identifier: BSD-3-Clause
// The bodies of one of Bullet's simulation islands during a step: mass, drive, displacement and velocity.
//
// A step has two different outputs:
//
// 1. The displacement: by the push (which removes overlap) and then by the velocity u of the solve, which
//    depends on no restitution. All checks of the end pose use this displacement.
// 2. The end velocity: after rotation and restitution. The end velocity is u, except where a body's inertia
//    turns with it (a free body keeps its angular momentum, not its angular velocity) or where bodies bounce.
//
// Bullet has one velocity, by which it moves the body after the solver. If the end velocity differs from the
// displacement's, finish() places the body so that Bullet's motion at the end velocity leads exactly to the
// pose of the displacement.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <unordered_map>
#include <vector>

#include "vps/pose.h"

class btCollisionObject;
class btRigidBody;
class btTransform;

namespace vps::bullet {

using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< angular, then linear; in W
using Mat6 = Eigen::Matrix<double, 6, 6>;

inline Vec6 stacked(const Vec3& w, const Vec3& v) {
  Vec6 u;
  u << w, v;
  return u;
}

/// The scalar product of two lists with one vector for each body.
inline double sumOfProducts(std::span<const Vec6> a, std::span<const Vec6> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// A dynamic body. Twists are about its centre of mass. The body's velocity u solves effective_mass u =
/// momentum + coupling_impulse + the contacts' impulses.
struct IslandBody {
  btRigidBody* rigid = nullptr;
  double reach_m = 0;         ///< greatest distance of the body's points from its centre
  Vec6 start = Vec6::Zero();  ///< velocity before the step
  Mat6 mass = Mat6::Zero();
  Vec6 external_Ns = Vec6::Zero();  ///< impulse of gravity and of the user's forces in the step
  Vec6 momentum = Vec6::Zero();     ///< mass times the velocity of the displacement by external forces alone
  bool turns_freely =
      true;  ///< the body keeps its angular momentum; false if Bullet's gyroscopic flags are off
  Vec3 rest_momentum_Nms =
      Vec3::Zero();  ///< angular momentum with external torques, minus the angular part of `momentum`
  Mat6 effective_mass = Mat6::Zero();  ///< mass plus the implicit part of the body's couplings
  Mat6 effective_inverse = Mat6::Zero();
  Vec6 coupling_impulse = Vec6::Zero();  ///< constant part of the body's couplings
  Vec6 u = Vec6::Zero();                 ///< velocity; at first that of the last step
  double way_share = 1;  ///< share of the step's motion (u and push) that the body makes; see endEarly()

  /// Momentum at the end of the step: angular about its centre, then linear.
  [[nodiscard]] Vec6 ended() const {
    Vec6 sum = mass * u;
    sum.head<3>() += rest_momentum_Nms;
    return sum;
  }
};

/// Solution for each body, before the step is possibly shortened (endEarly()).
struct StepSolution {
  std::vector<Vec6> u;
  std::vector<Vec6> momenta;  ///< at the end of the step: angular about the body's centre, then linear
  bool is_cut_short = false;
};

/// Pose and velocity of a body at the end of the step. The velocity is about its centre of mass.
struct BodyEnd {
  Pose X_WB;
  Mat6 mass = Mat6::Zero(), inverse_mass = Mat6::Zero();
  Vec6 v = Vec6::Zero();  ///< the end velocity
};

/// Angular velocity, about the common centre of mass, with which the bodies, joined rigidly at these poses,
/// have the sum of these momenta.
/// @param momenta  momentum of each body: angular about its centre, then linear
Vec3 commonTurn(std::span<const Vec6> momenta, std::span<const BodyEnd> ends);

/// Adds an angular velocity of all bodies about their common centre of mass.
void addTurn(const Vec3& w_W, std::span<BodyEnd> ends);

/// Result of an iterative solution of the island.
struct SolveOutcome {
  int steps = 0;
  bool is_converged = false;
};

class Island {
 public:
  /// True if the island can solve the body. False for a body with linear or angular factors, or with infinite
  /// inertia, whose mass matrix cannot be inverted.
  [[nodiscard]] static bool takes(const btRigidBody& rigid);
  void clear();
  void add(btRigidBody& rigid, double dt_s);
  /// Index of a body in `bodies`; -1 for an object that contact does not move.
  [[nodiscard]] int indexOf(const btCollisionObject* object) const;
  /// Velocity, about its origin, of a kinematic body, which is not in the island.
  [[nodiscard]] static Vec6 fixedVelocity(const btCollisionObject* object);
  /// Pose of a body's frame at the end of the step: moved by `push`, then by its velocity, as Bullet does. A
  /// kinematic body moves at its velocity.
  /// @param push  velocities that change positions only, one for each body; may be empty
  [[nodiscard]] Pose endPose(const btCollisionObject* object, std::span<const Vec6> push, double dt_s) const;
  /// Reads each body's end pose, and its end velocity without restitution, which keeps the angular momentum.
  void readEnds(std::span<const Vec6> push, double dt_s, std::vector<BodyEnd>& ends) const;
  /// Writes the end velocities, and places the bodies so that Bullet's own motion leads to their end poses.
  void finish(std::span<const Vec6> push, double dt_s, std::span<const BodyEnd> ends) const;
  void readVelocities(std::vector<Vec6>& u) const;
  void readSolution(StepSolution& solution) const;
  /// Greatest speed of any point of the bodies at these twists, one per body [m/s]; infinite if a twist is
  /// not finite.
  [[nodiscard]] double topSpeed(std::span<const Vec6> twists) const;

  std::vector<IslandBody> bodies;

 private:
  [[nodiscard]] btTransform pushed(std::size_t i, std::span<const Vec6> push, double dt_s) const;
  [[nodiscard]] btTransform endTransform(std::size_t i, std::span<const Vec6> push, double dt_s) const;

  std::unordered_map<const btCollisionObject*, int> index_;
};

/// Constant angular velocity W of a free body's rotation in a step. With W the body keeps both angular
/// momentum and energy, and a body that spins about a principal axis turns at exactly its angular velocity.
/// All vectors are in the body's principal frame B.
///
/// W solves J W + h(W) W x J W = J w, with h = tan(|W| dt / 2) / |W|.
///
/// Let R0 and R1 = R0 exp(W dt) be the rotation before and after the step, and w1 the velocity after it that
/// keeps the momentum: R1 J w1 = R0 J w. Written with Cayley's transform, exp(W dt) = (1 - hW)^-1 (1 + hW),
/// momentum says J (w1 - w) + hW x J (w1 + w) = 0, which the equation above solves with w1 = 2 W - w. So (w1
/// + w) / 2 = W, and the product with w1 + w gives w1 J w1 = w J w: the energy is kept for any h. [Simo and
/// Wong 1991; with h = dt / 2 their ALGO_C1, which turns a spinning disc too slowly by (w dt)^2 / 12.]
///
/// If |W| dt is above pi / 4, Bullet turns a body by less: by 2 atan(h |W|) with h = tan(pi / 8) / (pi / 4)
/// dt. Momentum and energy are kept with Bullet's h too.
///
/// @param inertia_kg_m2  principal moments J, positive
/// @param w_B            angular velocity before the step, with the torques that act in it [rad/s]
/// @return W [rad/s]; w_B itself if it is zero, or if no W is found: where a value is not
/// finite, or for inertias that no body has (one above the sum of the others)
/// Newton's method: two to four iterations of a 3x3 system below 100 rad/s at 1 kHz.
Vec3 meanAngularVelocity(const Vec3& inertia_kg_m2, const Vec3& w_B, double dt_s);

}  // namespace vps::bullet
