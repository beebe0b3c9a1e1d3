// SPDX-License-Identifier: BSD-3-Clause
// Stores that the pairs of one installation share with the solver, which finds them through the dispatcher.
//
// Bullet passes the dispatcher to solveGroup() but has no user pointer in manifolds or dispatchers. The
// create function that install() registers for pairs of Shapes is in the dispatcher's own table, so it holds
// these stores. No other state connects installation and solver.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <span>

class btCollisionObject;
class btDispatcher;
class btPersistentManifold;

namespace vps::bullet {

struct PenaltyPair;
class StepCheck;

/// The penalty points that belong to each manifold, for the pairs of one installation.
class PenaltyContacts {
 public:
  /// Thread-safe: btCollisionDispatcherMt processes pairs in parallel.
  void add(const btPersistentManifold* manifold, PenaltyPair* pair);
  void remove(const PenaltyPair* pair);

  /// Null if the manifold has no penalty points, so that its own points are rigid contacts. Takes no lock,
  /// since Bullet solves after all pairs have been processed.
  [[nodiscard]] PenaltyPair* find(const btPersistentManifold* manifold) const;

  /// True once a Solver has used this store.
  [[nodiscard]] bool hasSolver() const { return has_solver_; }
  void setHasSolver() { has_solver_ = true; }
  /// True once a Solver has passed an island to Bullet's own solver, which calls no StepCheck.
  [[nodiscard]] bool hasLeftIslands() const { return has_left_islands_; }
  void setHasLeftIslands() { has_left_islands_ = true; }

 private:
  std::mutex mutex_;
  std::map<const btPersistentManifold*, PenaltyPair*> pairs_;
  std::atomic<bool> has_solver_{false}, has_left_islands_{false};
};

/// The check of each pair, by the pair's first manifold, for the pairs of one installation.
class StepChecks {
 public:
  /// Thread-safe: btCollisionDispatcherMt processes pairs in parallel.
  void add(const btPersistentManifold* manifold, StepCheck* check);
  void remove(const btPersistentManifold* manifold);
  /// Null if the manifold is not the first one of a pair with a check. Takes no lock, since Bullet solves
  /// after all pairs have been processed.
  [[nodiscard]] StepCheck* find(const btPersistentManifold* manifold) const;

 private:
  std::mutex mutex_;
  std::map<const btPersistentManifold*, StepCheck*> checks_;
};

/// Which warnings about turns one installation has reported.
struct TurnReports {
  bool is_on = true;  ///< Settings::warns_of_turns
  std::atomic_flag clamped, in_contact;
};

/// Reports once (log.h) a body that Bullet turns in a step by less than its angular velocity times the step.
/// O(bodies).
void reportClampedTurn(TurnReports& reports, std::span<btCollisionObject* const> bodies, double dt_s);

/// Reports once bodies in contact that turn too far against each other in a step.
/// @param w_rad_s  rate of the bodies' relative rotation
void reportContactTurn(TurnReports& reports, const btCollisionObject& body0, const btCollisionObject& body1,
                       double w_rad_s, double dt_s);

/// The create function that install() registers, as the solver sees it.
struct ContactCreateFunction : btCollisionAlgorithmCreateFunc {
  std::shared_ptr<PenaltyContacts> penalty_contacts;
  std::shared_ptr<StepChecks> step_checks;
  std::shared_ptr<TurnReports> turn_reports;
};

/// The create function of the installation on this dispatcher; null without an installation.
ContactCreateFunction* contactFunctionOf(const btDispatcher* dispatcher);

/// Bullet's shape type of a bullet::Shape. See shape.h for the reason.
inline constexpr int kShapeType = FAST_CONCAVE_MESH_PROXYTYPE;

struct DispatchTable : btCollisionDispatcher {
  using Functions =
      btCollisionAlgorithmCreateFunc* [MAX_BROADPHASE_COLLISION_TYPES][MAX_BROADPHASE_COLLISION_TYPES];
  static const Functions& contact(const btCollisionDispatcher& d) {
    return d.*(&DispatchTable::m_doubleDispatchContactPoints);
  }
  static const Functions& closest(const btCollisionDispatcher& d) {
    return d.*(&DispatchTable::m_doubleDispatchClosestPoints);
  }
};

}  // namespace vps::bullet
