// SPDX-License-Identifier: BSD-3-Clause
// A constraint solver for stiffly coupled small parts: drop-in for btSequentialImpulseConstraintSolver.
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <cstddef>
#include <memory>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

struct SolverSettings {
  double residual_m_s = 1e-7;  ///< converged when no contact's velocity changes by more than this; > 0
  /// For rigid contacts: number of sweeps, where a step of Newton's method counts as ten; below 40 only
  /// sweeps are used. Newton's method may always take sixty steps, or three per body, even if that exceeds
  /// this limit. For penalty contacts: steps of Newton's method in all rounds. >= 1
  int iteration_limit = 400;
  /// Greatest number of penalty points of one island that are solved one by one; 0: no limit. If more points
  /// are near, up to 256 neighbours are solved as one point, the deepest, with the stiffness of all, which a
  /// message (log.h) reports once. A step takes 1 to 2 us per solved point.
  std::size_t point_limit = 8000;
};

/// Solves islands of rigid bodies, contacts (constraint or penalty), joints and CouplingConstraints; the
/// couplings become part of the bodies' effective mass (see solver.cpp). Islands with contact stiffness
/// flags, rolling, spinning or anisotropic friction, or bodies with linear or angular factors or without
/// inertia are passed to the stock solver unchanged.
///
/// Penalty contacts are found through the dispatcher that the world passes to solveGroup(), so the solver
/// needs no connection of its own. Without install() on that dispatcher, or without a dispatcher, every
/// contact is the rigid one in its manifold.
class VPS_BULLET_API Solver : public btSequentialImpulseConstraintSolver {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  /// Throws std::invalid_argument for settings out of range.
  explicit Solver(const SolverSettings& settings = {});
  ~Solver() override;

  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;

  /// Iterations of the last island that this solver solved, counted as for iteration_limit, without up to 30
  /// final sweeps.
  [[nodiscard]] int iterationsUsed() const { return iterations_used_; }
  /// Number of penalty points that were solved for the last island, and number of points that were near.
  [[nodiscard]] std::size_t pointsSolved() const { return points_solved_; }
  [[nodiscard]] std::size_t pointsNear() const { return points_near_; }
  /// True if the last island reached the residual, or 1e-5 of the bodies' greatest speed if this is larger.
  [[nodiscard]] bool hasConverged() const { return is_converged_; }
  /// Number of steps in which bodies of an island moved only a share of their motion, because no contacts
  /// were found that keep them apart at the end of the step. The bodies' velocities are not changed.
  [[nodiscard]] std::size_t shortenedSteps() const { return shortened_steps_; }
  /// Number of steps in which bodies of an island were moved apart without a velocity, because they
  /// overlapped or their sharp features were nearer than the rest gap. A pushed step does not conserve
  /// angular momentum, which changes by m d x v for each body, where the displacement d is below a micrometre
  /// unless bodies began inside each other.
  [[nodiscard]] std::size_t pushedSteps() const { return pushed_steps_; }

 private:
  struct Work;
  void reportGroups();
  SolverSettings settings_;
  std::unique_ptr<Work> work_;
  int iterations_used_ = 0;
  bool is_converged_ = true;
  std::size_t shortened_steps_ = 0, pushed_steps_ = 0;
  std::size_t points_solved_ = 0, points_near_ = 0;
  bool has_reported_groups_ = false;
};

}  // namespace vps::bullet
