// SPDX-License-Identifier: BSD-3-Clause
// How penalty points reach the solver: by manifold, in a store found through the dispatcher.
//
// Bullet passes the dispatcher to solveGroup() but has no user pointer in manifolds or dispatchers. The
// create function that install() registers for pairs of Shapes is in the dispatcher's own table, so it
// carries the store. No other state connects installation and solver.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>

class btDispatcher;
class btPersistentManifold;

namespace vps::bullet {

struct PenaltyPair;
class StepChecks;
struct TurnReports;

/// The pair of penalty points behind each manifold, for the pairs of one installation.
class PenaltyContacts {
 public:
  /// Thread-safe: btCollisionDispatcherMt processes pairs in parallel.
  void add(const btPersistentManifold* manifold, PenaltyPair* pair);
  void remove(const PenaltyPair* pair);

  /// Null: the manifold's own contacts are all there is. Takes no lock: Bullet solves after all pairs have
  /// been processed.
  [[nodiscard]] PenaltyPair* find(const btPersistentManifold* manifold) const;

  /// True once a Solver has used this store.
  [[nodiscard]] bool hasSolver() const { return has_solver_; }
  void setHasSolver() { has_solver_ = true; }
  /// True once it has left an island to Bullet's own solver, which asks no pair for its missing contacts.
  [[nodiscard]] bool hasLeftIslands() const { return has_left_islands_; }
  void setHasLeftIslands() { has_left_islands_ = true; }

 private:
  std::mutex mutex_;
  std::map<const btPersistentManifold*, PenaltyPair*> pairs_;
  std::atomic<bool> has_solver_{false}, has_left_islands_{false};
};

/// Base of the create function that install() registers.
struct ContactCreateFunction : btCollisionAlgorithmCreateFunc {
  std::shared_ptr<PenaltyContacts> penalty_contacts;
  std::shared_ptr<StepChecks> step_checks;
  std::shared_ptr<TurnReports> turn_reports;
};

/// The create function of the installation on this dispatcher, with its stores; null without one.
ContactCreateFunction* contactFunctionOf(const btDispatcher* dispatcher);

}  // namespace vps::bullet
