// SPDX-License-Identifier: BSD-3-Clause
// A constraint solver for stiffly coupled small parts: drop-in for btSequentialImpulseConstraintSolver.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <memory>

namespace vps {

struct VpsSolverSettings {
  double residual_m_s = 1e-7;  ///< stop when no row's velocity error changes by more
  int iteration_limit = 400;   ///< sweeps over all contacts, >= 1
};

/// Solves islands of rigid bodies, contacts and VpsCouplings with the coupling folded into the body's
/// effective mass (see solver.cpp); everything else (joints, soft constraints) goes to the stock solver
/// unchanged.
class VpsSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  explicit VpsSolver(const VpsSolverSettings& settings = {});
  ~VpsSolver() override;

  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;

  /// Gauss-Seidel sweeps that the last island solved by our method took; iteration_limit means it was cut
  /// short.
  [[nodiscard]] int iterationsUsed() const { return iterations_used_; }

 private:
  struct Work;
  /// Copies the island into work_; false if it holds anything our method does not cover.
  bool gather(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
              int manifold_count, btTypedConstraint** constraints, int constraint_count,
              const btContactSolverInfo& info);
  VpsSolverSettings settings_;
  std::unique_ptr<Work> work_;
  int iterations_used_ = 0;
};

}  // namespace vps
