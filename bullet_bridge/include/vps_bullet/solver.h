// SPDX-License-Identifier: BSD-3-Clause
// A constraint solver for stiffly coupled small parts: drop-in for btSequentialImpulseConstraintSolver.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <memory>

namespace vps {

struct VpsSolverSettings {
  double residual_m_s = 1e-7;  ///< stop when no contact's velocity changes by more
  /// Sweeps over rigid contacts, one of Newton's steps counting as ten, or Newton's steps of compliant ones;
  /// >= 1. Up to 30 it is sweeps alone.
  int iteration_limit = 400;
};

/// Solves islands of rigid bodies, contacts (rigid or compliant), joints and VpsCouplings, the couplings
/// folded into the bodies' effective mass (see solver.cpp). Islands with soft contact flags, rolling or
/// spinning friction, or bodies with linear or angular factors go to the stock solver unchanged.
class VpsSolver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  explicit VpsSolver(const VpsSolverSettings& settings = {});
  ~VpsSolver() override;

  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;

  /// What the last island solved by our method took, as iteration_limit counts; that limit: it was cut short.
  [[nodiscard]] int iterationsUsed() const { return iterations_used_; }

 private:
  struct Work;
  VpsSolverSettings settings_;
  std::unique_ptr<Work> work_;
  int iterations_used_ = 0;
};

}  // namespace vps
