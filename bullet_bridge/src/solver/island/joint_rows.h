// SPDX-License-Identifier: BSD-3-Clause
// Bullet's joints, motors and limits as rows of one island.
#pragma once

#include <span>
#include <vector>

#include "solver/island/island.h"

class btTypedConstraint;
struct btContactSolverInfo;

namespace vps::bullet {

/// One degree of freedom that a joint constrains or drives: J u = target - cfm * impulse, within the limits
/// of the impulse.
struct JointRow {
  btTypedConstraint* joint = nullptr;
  int body[2] = {-1, -1};  ///< index in the island; -1 for a body that the solver does not move
  Vec6 J[2] = {Vec6::Zero(), Vec6::Zero()};
  double fixed_velocity = 0;  ///< velocity along the row of bodies that the solver does not move
  double target = 0;
  double cfm = 0;  ///< constraint force mixing, as a share of the row's inverse mass
  double lower_Ns = 0, upper_Ns = 0;
  double impulse_Ns = 0;

  /// A limit of this size or more counts as none: Bullet's infinity is 1e18 or 1e30.
  static constexpr double kAny_Ns = 1e15;
  /// True for motors, limits and joints that break.
  [[nodiscard]] bool isBounded() const { return lower_Ns > -kAny_Ns || upper_Ns < kAny_Ns; }

  /// @param twistOf  a body's twist by its index
  template <typename TwistOf>
  [[nodiscard]] double velocity(const TwistOf& twistOf) const {
    double v = fixed_velocity;
    for (int i = 0; i < 2; ++i)
      if (body[i] >= 0) v += J[i].dot(twistOf(static_cast<std::size_t>(body[i])));
    return v;
  }
  [[nodiscard]] double velocity(const Island& island) const {
    return velocity([&](std::size_t i) -> const Vec6& { return island.bodies[i].u; });
  }
  /// J effective_mass^-1 J'; also writes each body's effective_mass^-1 J' to MinvJ, if given.
  double inverseMass(const Island& island, Vec6 (*MinvJ)[2] = nullptr) const;
};

class JointRows {
 public:
  void clear() { rows.clear(); }
  /// Adds the rows of an enabled joint.
  void add(btTypedConstraint& joint, const Island& island, const btContactSolverInfo& info);
  /// Makes the end velocities along rows without limits equal to the displacement's, and adds the impulses
  /// for that. End velocity and displacement differ because a body's inertia turns with it; without this
  /// correction the body would leave its hinge, by half of the effect of the hinge's torque in a step.
  void hold(const Island& island, std::span<BodyEnd> ends);
  /// Writes the impulses to the joints and their feedback, and disables joints that break.
  void finish(double dt_s);

  std::vector<JointRow> rows;
};

}  // namespace vps::bullet
