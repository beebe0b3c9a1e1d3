// SPDX-License-Identifier: BSD-3-Clause
// What the pairs of one installation share with the solver, found through the dispatcher.
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

/// The check behind the first manifold of each pair, for the pairs of one installation.
class StepChecks {
 public:
  /// Thread-safe: btCollisionDispatcherMt processes pairs in parallel.
  void add(const btPersistentManifold* manifold, StepCheck* check);
  void remove(const btPersistentManifold* manifold);
  /// Null: not of a pair that checks, or not its first manifold. Takes no lock: Bullet solves after all pairs
  /// have been processed.
  [[nodiscard]] StepCheck* find(const btPersistentManifold* manifold) const;

 private:
  std::mutex mutex_;
  std::map<const btPersistentManifold*, StepCheck*> checks_;
};

/// What one installation has reported.
struct TurnReports {
  bool is_on = true;  ///< Settings::warns_of_turns
  std::atomic_flag clamped, in_contact;
};

/// Reports (log.h) a body that Bullet turns by less than its speed, once. O(bodies).
void reportClampedTurn(TurnReports& reports, std::span<btCollisionObject* const> bodies, double dt_s);

/// Reports bodies in contact that turn too far against each other, once.
/// @param w_rad_s  of their relative rotation
void reportContactTurn(TurnReports& reports, const btCollisionObject& body0, const btCollisionObject& body1,
                       double w_rad_s, double dt_s);

/// Base of the create function that install() registers.
struct ContactCreateFunction : btCollisionAlgorithmCreateFunc {
  std::shared_ptr<PenaltyContacts> penalty_contacts;
  std::shared_ptr<StepChecks> step_checks;
  std::shared_ptr<TurnReports> turn_reports;
};

/// The create function of the installation on this dispatcher, with its stores; null without one.
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
