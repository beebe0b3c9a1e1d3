// SPDX-License-Identifier: BSD-3-Clause
// A constraint solver for stiffly coupled small parts: drop-in for btSequentialImpulseConstraintSolver.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <memory>

#include "vps_bullet/export.h"

namespace vps::bullet {

struct SolverSettings {
  double residual_m_s = 1e-7;  ///< stop when no contact's velocity changes by more
  /// Sweeps over rigid contacts, a step of Newton's method counting as ten; below 40 it is sweeps alone. Of
  /// compliant contacts: Newton's steps. >= 1
  int iteration_limit = 400;
};

/// Solves islands of rigid bodies, contacts (rigid or compliant), joints and VpsCouplings, the couplings
/// folded into the bodies' effective mass (see solver.cpp). Islands with soft contact flags, rolling or
/// spinning friction, or bodies with linear or angular factors or no inertia go to the stock solver
/// unchanged.
class VPS_BULLET_API Solver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  explicit Solver(const SolverSettings& settings = {});
  ~Solver() override;

  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;

  /// What the last island solved by our method took, counted as iteration_limit is; what is left open in the
  /// end is swept 30 times more.
  [[nodiscard]] int iterationsUsed() const { return iterations_used_; }
  /// Whether that came down to the residual, or for parts in motion to 1e-5 of their speed.
  [[nodiscard]] bool hasSettled() const { return is_settled_; }

 private:
  struct Work;
  SolverSettings settings_;
  std::unique_ptr<Work> work_;
  int iterations_used_ = 0;
  bool is_settled_ = true;
};

}  // namespace vps::bullet
