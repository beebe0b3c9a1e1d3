// SPDX-License-Identifier: BSD-3-Clause
// The virtual coupling: a spring-damper between a device's proxy and a part, solved together with the
// contacts.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "vps/coupling_law.h"
#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

class btConstraintSolver;
class btRigidBody;

namespace vps::bullet {

/// A 6-DOF spring-damper between a target (the device's proxy at the end of the step) and a point of a
/// dynamic body. Implicit: the wrench is that of the coupling law at the end of the step, solved together
/// with the contact impulses. The coupling is therefore stable for any gains, and on a part at rest its
/// wrench equals couplingWrench(). The spring's force and torque are limited separately, keeping their
/// directions.
///
/// The constraint has no solver rows; its 6x6 block is solved in solveConstraintObsolete, once per iteration.
/// Add the constraint with world.addConstraint(&coupling, true): with `true` the contact query includes the
/// coupling's pull in its prediction. Equal inputs give equal bits: no state is kept from step to step.
class VPS_BULLET_API CouplingConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param X_BG  the grasp frame G in the part's body frame. The coupling is open (no wrench) until
  ///   setTarget(). Throws std::invalid_argument for a body without mass, or gains that are negative or not
  ///   finite.
  CouplingConstraint(btRigidBody& part, const Pose& X_BG, const CouplingGains& gains);
  /// The target follows a kinematic body: X_AG is the grasp frame in the proxy's body frame. Sets
  /// CF_NO_CONTACT_RESPONSE on the proxy, so that it does not collide. Throws std::invalid_argument also for
  /// a proxy that is not kinematic or static.
  CouplingConstraint(btRigidBody& proxy, const Pose& X_AG, btRigidBody& part, const Pose& X_BG,
                     const CouplingGains& gains);

  /// The proxy's grasp frame at the END of the coming step, in W, and its velocity; valid until the next
  /// call. A target that is not finite, or not is_coupled, opens the coupling. The target takes precedence
  /// over the proxy body.
  void setTarget(const CouplingState& target);
  /// Opens the coupling: no wrench until the next setTarget.
  void release();
  void setGains(const CouplingGains& gains);
  [[nodiscard]] const CouplingGains& gains() const { return gains_; }

  /// The part's grasp frame now, in W; time_s is the target's.
  [[nodiscard]] CouplingState partState() const;
  /// Wrench on the part in the last step (impulse / dt), in W, about the position of its grasp point at the
  /// start of the step.
  [[nodiscard]] const Wrench& wrench() const { return F_PG_W_; }
  /// Velocity (about the body's origin, in W) that the coupling alone would add to the part in a step. The
  /// contact query uses this velocity to predict how far points can move.
  [[nodiscard]] Twist freeVelocity(double dt_s) const;

  /// Reason why the coupling has no effect with `solver`; nullptr if the coupling works. A coupling needs a
  /// solver that calls solveConstraintObsolete: btSequentialImpulseConstraintSolver or bullet::Solver.
  [[nodiscard]] static const char* unsupportedReason(const btConstraintSolver& solver);

  void buildJacobian() override;
  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void solveConstraintObsolete(btSolverBody& part, btSolverBody& other, btScalar dt_s) override;
  void setParam(int num, btScalar value, int axis = -1) override;
  [[nodiscard]] btScalar getParam(int num, int axis = -1) const override;

 private:
  friend class Solver;
  using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< angular, then linear; at the grasp point, in W
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  /// Constants of a step.
  struct Step {
    bool is_open = true;
    double dt_s = 0;
    Vec3 r_W = Vec3::Zero();  ///< vector from the body's origin to the grasp point
    Vec6 error, V_target;     ///< present pose error and target velocity
    Mat6 A;                   ///< inverse inertia seen at the grasp point
  };
  /// impulse = c - D V, with the part's grasp velocity V at the end of the step. Bits of `limited`: 0 torque,
  /// 1 force.
  struct Law {
    Vec6 c, D;
    int limited = 0;
  };

  [[nodiscard]] CouplingState currentTarget() const;
  [[nodiscard]] Step makeStep(double dt_s) const;
  /// The law at the velocity V_G, with the limits of the springs; with `unlimited`, without limits.
  [[nodiscard]] Law lawAt(const Step& step, const Vec6& V_G, bool unlimited = false) const;
  /// The impulse that satisfies the law, given the velocity that the grasp point would have without the
  /// coupling.
  [[nodiscard]] Vec6 solveImpulse(const Step& step, const Vec6& V_without) const;
  void setImpulse(const Vec6& impulse, double dt_s);

  btRigidBody& part_;
  btRigidBody* proxy_ = nullptr;
  Pose X_AG_, X_BG_;
  CouplingGains gains_;
  CouplingState target_;
  bool is_prepared_ = false;
  Step step_;
  Vec6 impulse_ = Vec6::Zero();  ///< accumulated over the step, about the grasp point
  Wrench F_PG_W_;
};

}  // namespace vps::bullet
