// SPDX-License-Identifier: BSD-3-Clause
// Rigid contact: projected Gauss-Seidel over joints and the few contacts in Bullet's manifolds.
//
// Signorini in the normal direction (gap at the end of the step >= 0), Coulomb's cone (not a pyramid) in the
// tangent plane. Overlap is pushed out afterwards in a second, frictionless solve whose velocities move the
// bodies once and are forgotten, so that no energy enters (split impulse). Sources: Catto 2005 (sequential
// impulses); Jourdan, Alart and Jean 1998 (Gauss-Seidel for frictional contact).
#pragma once

#include <vector>

#include "solver/island.h"
#include "solver/joint_rows.h"
#include "vps_bullet/solver.h"

class btCollisionObject;
class btManifoldPoint;
class btPersistentManifold;
struct btContactSolverInfo;

namespace vps::bullet {

/// One direction of a contact: a row of its Jacobian.
struct ContactRow {
  struct Side {
    int body = -1;          ///< -1: not moved by contact
    Vec6 J = Vec6::Zero();  ///< so that J . u is the velocity along the row's direction
    Vec6 MinvJ = Vec6::Zero();
  };
  Side side[2];
  double fixed_velocity = 0;  ///< of a kinematic partner, along the direction
  double W = 0;               ///< J held^-1 J'
};

/// A contact of a manifold as the solver sees it.
struct RigidContact {
  btManifoldPoint* point = nullptr;
  const btCollisionObject* object[2] = {nullptr, nullptr};
  ContactRow normal, tangent[2];
  double target_m_s = 0;  ///< least normal velocity
  double gap_m = 0;
  double mu = 0;
  double p_n = 0, p_t[2] = {0, 0}, p_push = 0;  ///< impulses [N s]
  double W_t_inverse[3] = {0, 0, 0};            ///< of the 2x2 tangent block: 11, 12, 22
  double W_t = 0;                               ///< its greatest eigenvalue
};

class ContactSweeps {
 public:
  ContactSweeps(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  void clear() { contacts_.clear(); }
  void add(btPersistentManifold& manifold, btManifoldPoint& point, const btContactSolverInfo& info);
  /// Starts from last step's impulses, each body's mass being `held`.
  void start();
  /// Sweeps until no row's velocity changes by more than residual_m_s, at most `limit` times.
  SolveOutcome sweep(double residual_m_s, int limit);
  /// Velocities of the bodies by the contacts' impulses as they stand.
  void applyImpulses();
  [[nodiscard]] std::vector<RigidContact>& contacts() { return contacts_; }
  /// Pushes out, by a share and without leaving velocity behind, the overlap left at the end of the step.
  void solvePush(const btContactSolverInfo& info, int sweep_limit);
  /// Leaves impulses in the manifolds and moves the bodies by the push.
  void finish(double dt_s);

 private:
  [[nodiscard]] IslandBody& body(const ContactRow::Side& side) const {
    return island_.bodies[static_cast<std::size_t>(side.body)];
  }
  [[nodiscard]] ContactRow makeRow(const btCollisionObject* const (&objects)[2], const btManifoldPoint& point,
                                   const Vec3& d) const;
  void prepareRow(ContactRow& row) const;
  void prepare();
  double sweepOnce();
  double sweepJoints();
  [[nodiscard]] double velocity(const ContactRow& row) const;
  void apply(const ContactRow& row, double impulse);

  /// A joint's row, prepared.
  struct Drive {
    JointRow* row;
    Vec6 MinvJ[2];
    double W;
  };

  void pushJoint(const Drive& drive);

  Island& island_;
  JointRows& joints_;
  std::vector<Drive> drives_;
  std::vector<RigidContact> contacts_;
  std::vector<Vec6> push_;  // velocities that only move, for one step
};

}  // namespace vps::bullet
