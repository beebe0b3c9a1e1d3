// SPDX-License-Identifier: BSD-3-Clause
// Constraint contact: projected Gauss-Seidel over joints and the few contacts in Bullet's manifolds.
//
// The contact laws are Signorini's condition in the normal direction (gap at the end of the step >= 0) and
// Coulomb's cone (not a pyramid) in the tangent plane. A second, frictionless solve then removes overlap; its
// velocities move the bodies once and are discarded, so that no energy is added (split impulse). Neither
// solve includes restitution: see restitution.h. Sources: Catto 2005 (sequential impulses); Jourdan, Alart
// and Jean 1998 (Gauss-Seidel for frictional contact).
#pragma once

#include <span>
#include <vector>

#include "solver/island/island.h"
#include "solver/island/joint_rows.h"
#include "solver/rigid/step_check.h"
#include "vps_bullet/solver.h"

class btCollisionObject;
class btManifoldPoint;
class btPersistentManifold;
struct btContactSolverInfo;

namespace vps::bullet {

/// One direction of a contact: a row of its Jacobian.
struct ContactRow {
  struct Side {
    int body = -1;          ///< index in the island; -1 for a body that contact does not move
    Vec6 J = Vec6::Zero();  ///< J . u is the velocity along the row's direction
    Vec6 MinvJ = Vec6::Zero();
  };
  Side side[2];
  double fixed_velocity = 0;  ///< velocity of a kinematic body along the direction
  double W = 0;               ///< J effective_mass^-1 J'

  /// Velocity along the direction.
  /// @param twistOf  returns the twist of a body, by its index
  template <typename TwistOf>
  [[nodiscard]] double velocity(const TwistOf& twistOf) const {
    double v = fixed_velocity;
    for (const Side& each : side)
      if (each.body >= 0) v += each.J.dot(twistOf(static_cast<std::size_t>(each.body)));
    return v;
  }
};

/// A contact of a manifold, with its rows.
struct RigidContact {
  btManifoldPoint* point = nullptr;
  const btCollisionObject* object[2] = {nullptr, nullptr};
  ContactRow normal, tangent[2];
  double target_m_s = 0;  ///< least normal velocity that the contact allows
  double push_m_s = 0;    ///< normal velocity that the push must reach at least
  double gap_m = 0;
  double area_m2 = 0;  ///< area of a touching face that the contact represents
  double mu = 0;
  double restitution = 0;  ///< 0 to 1
  bool is_sharp = false;   ///< contact of sharp features with a gap, which no push may reduce
  double p_n = 0, p_t[2] = {0, 0}, p_push = 0;  ///< impulses [N s]
  double W_t_inverse[3] = {0, 0, 0};            ///< inverse of the 2x2 tangent block: entries 11, 12, 22
  double W_t = 0;                               ///< greatest eigenvalue of the tangent block

  /// Point at which the contact forces act (the middle of the gap), and the directions of the forces.
  [[nodiscard]] Vec3 position_W() const;
  [[nodiscard]] Vec3 normal_W() const;
  [[nodiscard]] Vec3 tangent_W(int k) const;
};

class ContactSweeps {
 public:
  ContactSweeps(Island& island, JointRows& joints) : island_(island), joints_(joints) {}

  void clear() {
    contacts_.clear();
    push_.clear();  // these velocities belong to another island
  }
  void add(btPersistentManifold& manifold, btManifoldPoint& point, const btContactSolverInfo& info);
  /// Prepares the rows with the bodies' effective masses, and starts from last step's impulses.
  void start();
  /// Sweeps until no row's velocity changes by more than residual_m_s, at most `limit` times.
  SolveOutcome sweep(double residual_m_s, int limit);
  /// Sets the bodies' velocities from the present impulses.
  void applyImpulses();
  [[nodiscard]] std::vector<RigidContact>& contacts() { return contacts_; }
  /// Finds the push that removes a share of the overlap left at the end of the step, without adding velocity.
  void solvePush(const btContactSolverInfo& info, int sweep_limit);
  /// Adds the missed contacts, or gives existing contacts another plane. Each contact then keeps its bodies
  /// apart at the end of the step, to first order about the present velocities and push. A step must not end
  /// deeper than it began, so a contact may require a separating velocity.
  void addMissed(std::span<const MissedContact> missed, const btContactSolverInfo& info);
  /// Velocities of the push, one per body; empty if no push is needed.
  [[nodiscard]] std::span<const Vec6> push() const { return push_; }
  /// Writes the impulses to the manifolds.
  void finish() const;

 private:
  [[nodiscard]] IslandBody& body(const ContactRow::Side& side) const {
    return island_.bodies[static_cast<std::size_t>(side.body)];
  }
  bool makeRows(RigidContact& contact) const;
  void prepareRow(ContactRow& row) const;
  void prepare();
  void setFreeVelocities();
  [[nodiscard]] double pushVelocity(const ContactRow& row) const;
  double sweepOnce();
  double sweepJoints();
  [[nodiscard]] double velocity(const ContactRow& row) const;
  void apply(const ContactRow& row, double impulse);

  /// A joint's row with its inverse masses.
  struct JointState {
    JointRow* row;
    Vec6 MinvJ[2];
    double W;
  };

  void pushJoint(const JointState& joint);

  Island& island_;
  JointRows& joints_;
  std::vector<JointState> joint_states_;
  std::vector<RigidContact> contacts_;
  std::vector<Vec6> push_;  // velocities that change positions only, in one step
};

}  // namespace vps::bullet
