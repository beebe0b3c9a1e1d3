// SPDX-License-Identifier: BSD-3-Clause
// The virtual coupling's physics side: proxy and part joined by a spring-damper that is solved with the
// contacts.
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "vps/coupling_law.h"
#include "vps_bullet/export.h"

class btConstraintSolver;
class btRigidBody;

namespace vps::bullet {

/// A 6-DOF spring-damper between a target (the device's proxy at the end of the step) and a point of a
/// dynamic body. Implicit: the wrench is that of the law at the end of the step, found together with the
/// contact impulses, so it is stable for any gains and a part that stands still feels exactly
/// couplingWrench(). The spring's part of force and of torque is limited separately, keeping its direction.
///
/// Zero solver rows; the 6x6 block is solved in solveConstraintObsolete, once per iteration. Add it with
/// world.addConstraint(&coupling, true): `true` also tells the contact filter to look at the coupling's pull.
/// Same inputs give the same bits: no state passes from step to step.
class VPS_BULLET_API CouplingConstraint : public btTypedConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param X_BG  the grasp frame G in the part's body frame.
  /// Without setTarget() the coupling is open (no wrench). Throws std::invalid_argument for a body without
  /// mass, or gains that are negative or not finite.
  CouplingConstraint(btRigidBody& part, const Pose& X_BG, const CouplingGains& gains);
  /// Follows a kinematic body: X_AG is the grasp frame in the proxy's body frame. The proxy no longer
  /// collides (CF_NO_CONTACT_RESPONSE is set on it). Throws std::invalid_argument also for a proxy that is
  /// not kinematic or static.
  CouplingConstraint(btRigidBody& proxy, const Pose& X_AG, btRigidBody& part, const Pose& X_BG,
                     const CouplingGains& gains);

  /// The proxy's grasp frame at the END of the coming step, in W, and its velocity. Held until the next call.
  /// Not finite or not is_coupled: the coupling is open. Takes precedence over the proxy body.
  void setTarget(const CouplingState& target);
  /// Lets go: no wrench until the next setTarget.
  void release();
  void setGains(const CouplingGains& gains);
  [[nodiscard]] const CouplingGains& gains() const { return gains_; }
  void setGrasp(const Pose& X_BG) { X_BG_ = X_BG; }

  /// The part's grasp frame now, in W; time_s is the target's.
  [[nodiscard]] CouplingState partState() const;
  /// Wrench of the last step on the part about its grasp point (where it was at the start of the step), in W:
  /// accumulated impulse / dt.
  [[nodiscard]] const Wrench& wrench() const { return F_PG_W_; }
  /// What the coupling alone would make of the part's velocity (about the body's origin, in W) in a step:
  /// used by the contact filter to see how far points can come.
  [[nodiscard]] Twist freeVelocity(double dt_s) const;

  /// Why this coupling would not act with that solver, or nullptr when it does: only solvers that call
  /// solveConstraintObsolete (btSequentialImpulseConstraintSolver and our Solver) do.
  [[nodiscard]] static const char* whyUnsupported(const btConstraintSolver& solver);

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

  /// What stays the same during a step.
  struct Step {
    bool is_open = true;
    double dt_s = 0;
    Vec3 r_W = Vec3::Zero();  ///< from the body's origin to the grasp point
    Vec6 error, V_target;     ///< pose error now and target velocity
    Mat6 A;                   ///< inverse inertia seen at the grasp point
  };
  /// impulse = c - D V, V the part's grasp velocity at the end of the step. `limited`: bit 0 torque, bit 1
  /// force.
  struct Law {
    Vec6 c, D;
    int limited = 0;
  };

  [[nodiscard]] CouplingState currentTarget() const;
  [[nodiscard]] Step makeStep(double dt_s) const;
  /// The law with the springs' limits as they act at V_G; with `unlimited` as if there were none.
  [[nodiscard]] Law lawAt(const Step& step, const Vec6& V_G, bool unlimited = false) const;
  /// The impulse that satisfies the law, given the velocity the grasp point would have without it.
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
