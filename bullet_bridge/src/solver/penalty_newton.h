// SPDX-License-Identifier: BSD-3-Clause
// Compliant contact: the end-of-step velocities at which mass, couplings and thousands of springs balance.
//
// With all else fixed they minimise a convex function, the incremental potential of an implicit Euler step,
//
//     1/2 (u - u0)' M (u - u0) + sum 1/2 k min(gap + dt n.v, 0)^2 + sum H(bend + dt v_t)
//
// v a point's relative velocity, H the bristle: 1/2 k |x|^2 while it holds, and of constant slope mu f_n once
// it slips. Newton's method with an exact line search finds it; f_n in H is that of the round before. The
// answer's energy is never above that of standing still in the overlap. Sources: DESIGN's section 4.1 force;
// Kaufman et al. 2008 and Castro et al. 2021 for contact as convex minimisation; Dahl 1968 for the bristle.
#pragma once

#include <span>
#include <vector>

#include "solver/island.h"
#include "solver/island_matrix.h"
#include "solver/joint_rows.h"
#include "solver/penalty_patch.h"

namespace vps::bullet {

class PenaltyNewton {
 public:
  PenaltyNewton(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  void clear(double dt_s) {
    patch_count_ = 0;
    dt_s_ = dt_s;
  }
  /// The pair must outlive finish(). Friction's limits are at first those of the last step's forces.
  /// @param foresees_turning  of a turning body's points, that they go along circles
  void add(PenaltyPair& pair, bool foresees_turning = true);
  /// When to stop: after a step that changes no point's velocity by more than the residual; or when the
  /// momentum that is missing would change no point's by more, which asks for more where springs are stiff.
  enum class End { Short, Balanced };
  /// Velocities for the bodies' masses and the limits as they stand. Not settled: the limit came first, or
  /// something is no number.
  SolveOutcome solve(double residual_m_s, int iteration_limit, End end = End::Short);
  /// What the momentum that the last velocities looked at leave missing would do to the bodies. After a
  /// solve that ended Balanced those are the bodies'.
  [[nodiscard]] double imbalance_m_s();
  /// Limits of friction by the forces just found. Returns the greatest change, relative to the greatest
  /// limit.
  double renewLimits();
  /// Leaves forces and bends in the pairs' points.
  void finish();

 private:
  [[nodiscard]] std::span<PenaltyPatch> patches() { return {patches_.data(), patch_count_}; }
  [[nodiscard]] std::span<const PenaltyPatch> patches() const { return {patches_.data(), patch_count_}; }
  [[nodiscard]] Vec6 twistOf(const PenaltyPatch& patch, const std::vector<Vec6>& u) const;
  /// Gradient of the potential at u; with the Hessians of the patches if asked.
  void evaluateAll(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient);
  void startMatrix();
  /// False: the matrix is not positive definite.
  [[nodiscard]] bool newtonStep(const std::vector<Vec6>& gradient, std::vector<Vec6>& step);
  [[nodiscard]] double shareOf(const std::vector<Vec6>& u, const std::vector<Vec6>& step, double slope);
  [[nodiscard]] double greatestSpeed(const std::vector<Vec6>& step) const;

  /// Joints as springs of the velocity, so stiff that they miss their target by a millionth: their limits
  /// make the potential's slope constant, as a bristle's does.
  void prepareJoints();
  [[nodiscard]] double jointImpulse(const JointRow& row, double stiffness_kg,
                                    const std::vector<Vec6>& u) const;

  Island& island_;
  JointRows& joints_;
  std::vector<double> joint_kg_;       // stiffness of each row, against velocity
  std::vector<std::uint8_t> is_free_;  // rows within their limits at the last evaluation
  double dt_s_ = 0;
  IslandMatrix hessian_;
  std::vector<PenaltyPatch> patches_;  // kept for their memory
  std::size_t patch_count_ = 0;
  std::vector<Vec6> u_, gradient_, step_, trial_, trial_gradient_;
};

}  // namespace vps::bullet
