// SPDX-License-Identifier: BSD-3-Clause
// Penalty contact: finds the end-of-step velocities at which inertia, couplings and thousands of penalty
// points balance.
//
// These velocities minimise a convex function, the incremental potential of an implicit Euler step,
//
//     1/2 (u - u0)' M (u - u0) + sum 1/2 k min(gap + dt n.v, 0)^2 + sum H(bend + dt v_t)
//
// where M is the mass matrix, u0 the velocities without contact, v a point's relative velocity with the
// normal part n.v and the tangential part v_t, `bend` the deflection of the point's friction bristle, and H
// the bristle's potential: 1/2 k |x|^2 while it sticks, with the constant gradient mu f_n when it slips.
// Newton's method with an exact line search finds the minimum. The normal force f_n in H is that of the
// solution before (updateLimits()). The gradient of the potential is called the missing momentum. The energy
// of the solution never exceeds the energy of resting in the overlap. Sources: Tripicchio et al.,
// section 4.1, for the force; Kaufman et al. 2008 and Castro et al. 2021 for contact as convex minimisation;
// Dahl 1968 for the bristle.
#pragma once

#include <span>
#include <vector>

#include "solver/island/island.h"
#include "solver/island/island_matrix.h"
#include "solver/island/joint_rows.h"
#include "solver/penalty/penalty_patch.h"

namespace vps::bullet {

class PenaltyNewton {
 public:
  PenaltyNewton(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  void clear(double dt_s) {
    patch_count_ = 0;
    dt_s_ = dt_s;
  }
  /// Adds a pair, which must outlive finish(). The initial limits of friction follow from the last step's
  /// forces.
  /// @param level  level of groupPoints()
  /// @param follows_rotation  points of a rotating body move along circles instead of tangents
  void add(PenaltyPair& pair, int level = 0, bool follows_rotation = true);
  /// Number of points that are solved; a group counts as one.
  [[nodiscard]] std::size_t pointCount() const;
  /// Stopping criterion: a step changes no point's velocity by more than the residual (Short), or the missing
  /// momentum would change no point's velocity by more than the residual (Balanced; stricter for stiff
  /// contacts).
  enum class End { Short, Balanced };
  /// Finds the velocities for the present effective masses and friction limits. The outcome is not converged
  /// if the iteration limit was reached or a value is not finite.
  SolveOutcome solve(double residual_m_s, int iteration_limit, End end = End::Short);
  /// Greatest change of the bodies' velocities by the missing momentum at the velocities evaluated last.
  /// After a solve with End::Balanced the velocities evaluated last are the bodies' velocities.
  [[nodiscard]] double imbalance_m_s();
  /// Updates the limits of friction from the present forces. Returns the greatest change, relative to the
  /// greatest limit.
  double updateLimits();
  /// Writes forces and bristle deflections (PenaltyPoint::bend_W) to the pairs' points.
  void finish();

 private:
  [[nodiscard]] std::span<PenaltyPatch> patches() { return {patches_.data(), patch_count_}; }
  [[nodiscard]] std::span<const PenaltyPatch> patches() const { return {patches_.data(), patch_count_}; }
  [[nodiscard]] Vec6 twistOf(const PenaltyPatch& patch, const std::vector<Vec6>& u) const;
  /// Gradient of the potential at u; with_hessian: also the Hessians of the patches.
  void evaluateAll(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient);
  void startMatrix();
  /// Returns false if the matrix is not positive definite.
  [[nodiscard]] bool newtonStep(const std::vector<Vec6>& gradient, std::vector<Vec6>& step);
  [[nodiscard]] double shareOfStep(const std::vector<Vec6>& u, const std::vector<Vec6>& step, double slope);
  [[nodiscard]] double greatestSpeed(const std::vector<Vec6>& step) const;

  /// Joints are modelled as dampers of velocity error, so stiff that they miss their target by a millionth.
  /// At a limit the gradient of the dampers' potential is constant, as for a bristle.
  void prepareJoints();
  [[nodiscard]] double jointImpulse(const JointRow& row, double stiffness_kg,
                                    const std::vector<Vec6>& u) const;

  Island& island_;
  JointRows& joints_;
  std::vector<double> joint_kg_;       // impulse per velocity error of each row
  std::vector<std::uint8_t> is_free_;  // rows that were within their limits at the last evaluation
  double dt_s_ = 0;
  IslandMatrix hessian_;
  std::vector<PenaltyPatch> patches_;  // kept to reuse their memory
  std::size_t patch_count_ = 0;
  std::vector<Vec6> u_, gradient_, step_, trial_, trial_gradient_;
};

}  // namespace vps::bullet
