// SPDX-License-Identifier: BSD-3-Clause
// Parts held by Bullet's joints, together with contact and couplings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_bridge/world.h"
#include "vps/feature_motion.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::kGravity;
using test::kIsDouble;
using test::plate;
using test::SolverKind;
using test::steelBox;
using test::World;

/// A point given in the part's frame, in the body's frame.
btVector3 inBody(const Built& part, const Vec3& p_P) {
  return toBt(part.frame.X_PB.inverse() * p_P);
}

/// A direction given in the part's frame, in the body's frame.
btVector3 axisInBody(const Built& part, const Vec3& axis_P) {
  return toBt(Vec3(part.frame.X_PB.R.transpose() * axis_P));
}

/// A joint type that Bullet does not have: keeps a point of a body at a fixed distance from a point of the
/// world. A joint type is a class that writes its rows in getInfo2(); every solver reads them from there.
class Rod : public btTypedConstraint {
 public:
  Rod(btRigidBody& body, const Vec3& p_W, double length_m)
      : btTypedConstraint(MAX_CONSTRAINT_TYPE, body), p_W_(p_W), length_m_(length_m) {}
  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = 1;
    info->nub = 5;  // of the six degrees of freedom
  }
  void getInfo2(btConstraintInfo2* info) override {
    const Vec3 r = fromBt(getRigidBodyA().getCenterOfMassPosition()) - p_W_;
    const Vec3 n = r.normalized();
    for (int i = 0; i < 3; ++i) info->m_J1linearAxis[i] = toBt(n[i]);
    info->m_constraintError[0] = toBt(info->fps * info->erp * (length_m_ - r.norm()));
  }
  void setParam(int, btScalar, int) override {}
  [[nodiscard]] btScalar getParam(int, int) const override { return 0; }

 private:
  Vec3 p_W_;
  double length_m_;
};

class JointsWithSolver : public testing::TestWithParam<SolverKind> {};

TEST_P(JointsWithSolver, APendulumSwingsByTheFormula) {
  World world(GetParam());
  const Built box = steelBox();
  btRigidBody& body = world.add(box, Pose());
  // The box hangs at the middle of an edge, 10 mm from its centre, axis y. The pendulum starts at rest and
  // horizontal, with the angular acceleration m g l / I. After 20 steps the angle is 0.5 degrees.
  btHingeConstraint hinge(body, inBody(box, Vec3(-0.01, 0, 0)), axisInBody(box, Vec3(0, 1, 0)));
  world.world->addConstraint(&hinge);
  constexpr int kSteps = 20;
  world.step(kSteps);
  const double m = box.frame.mass_kg, l = 0.01, I = m / 12 * (0.02 * 0.02 + 0.01 * 0.01) + m * l * l;
  const double speed_rad_s = m * kGravity * l / I * kSteps * 1e-3;
  const double turned_rad = 0.5 * speed_rad_s * kSteps * 1e-3;
  // Tolerance: the cosine of the angle, and joint errors, of which a fifth is corrected in each step.
  EXPECT_NEAR(body.getAngularVelocity().length(), speed_rad_s,
              (turned_rad * turned_rad + 1e-3) * speed_rad_s);
  const Pose X_WP = test::partPose(body, box);
  // A step along the tangent leaves the circle by l (w dt)^2 / 2, of which a fifth is corrected in each step.
  EXPECT_LE((X_WP * Vec3(-0.01, 0, 0) - Vec3(-0.01, 0, 0)).norm(),
            l * std::pow(speed_rad_s * 1e-3, 2) / 2 / 0.2);
  world.world->removeConstraint(&hinge);
}

TEST_P(JointsWithSolver, AJointTypeOfTheHostsOwnHoldsItsBody) {
  World world(GetParam());
  const Built box = steelBox();
  constexpr double kLength_m = 0.1;
  btRigidBody& body = world.add(box, Pose::translation(Vec3(kLength_m, 0, 0)));
  Rod rod(body, Vec3::Zero(), kLength_m);
  world.world->addConstraint(&rod);
  double off_m = 0;
  for (int i = 0; i < 100; ++i) {
    world.step();
    off_m = std::max(off_m, std::abs(fromBt(body.getWorldTransform().getOrigin()).norm() - kLength_m));
  }
  const Vec3 p = fromBt(body.getWorldTransform().getOrigin());
  const double speed_m_s = fromBt(body.getLinearVelocity()).norm();
  // The body swings down from the side: v^2 / 2 = g h. A step along the tangent leaves the circle by (v dt)^2
  // / 2r, of which a fifth is corrected in each step; symplectic steps change the energy by about g dt v.
  EXPECT_LE(off_m, 1.1 * std::pow(speed_m_s * 1e-3, 2) / (2 * kLength_m) / 0.2);
  EXPECT_LT(p.z(), -0.03);
  EXPECT_NEAR(speed_m_s * speed_m_s / 2, -kGravity * p.z(), kGravity * 1e-3 * speed_m_s);
  world.world->removeConstraint(&rod);
}

TEST_P(JointsWithSolver, FeedbackIsTheWeight) {
  World world(GetParam());
  const Built box = steelBox();
  btRigidBody& body = world.add(box, Pose());
  btPoint2PointConstraint joint(body, inBody(box, Vec3(0, 0, 0.005)));
  btJointFeedback feedback;
  joint.setJointFeedback(&feedback);
  joint.enableFeedback(true);
  world.world->addConstraint(&joint);
  world.step(2000);
  const double weight_N = box.frame.mass_kg * kGravity;
  EXPECT_NEAR(feedback.m_appliedForceBodyA.z(), weight_N, (kIsDouble ? 1e-5 : 1e-3) * weight_N);
  world.world->removeConstraint(&joint);
}

TEST_P(JointsWithSolver, AMotorReachesItsSpeedWithinItsImpulseLimit) {
  World world(GetParam());
  world.world->setGravity(btVector3(0, 0, 0));
  const Built box = steelBox();
  btRigidBody& body = world.add(box, Pose());
  const Vec3 axis(0, 0, 1);
  btHingeConstraint hinge(body, inBody(box, Vec3::Zero()), axisInBody(box, axis));
  const double I = box.frame.mass_kg / 12 * (0.02 * 0.02 + 0.015 * 0.015);
  // The limit allows 2 rad/s in each step; the target is 10 rad/s.
  hinge.enableAngularMotor(true, 10, toBt(2 * I));
  world.world->addConstraint(&hinge);
  world.step(3);
  const double direction = body.getAngularVelocity().z() > 0 ? 1 : -1;
  EXPECT_NEAR(body.getAngularVelocity().z() * direction, 6, 6e-3);
  world.step(10);
  EXPECT_NEAR(body.getAngularVelocity().z() * direction, 10, 1e-2);
  world.world->removeConstraint(&hinge);
}

TEST_P(JointsWithSolver, AHingedPartLeansOnItsStopWithItsTorque) {
  World world(GetParam());
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  // The part lies on the plate, hinged at one lower edge. The plate's force balances the torque about the
  // edge; its distribution over the face is undetermined. The part must not move.
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  btHingeConstraint hinge(body, inBody(box, Vec3(-0.015, 0, 0)), axisInBody(box, Vec3(0, 1, 0)));
  world.world->addConstraint(&hinge);
  world.step(500);
  const Pose before = test::partPose(body, box);
  world.step(500);
  const Pose after = test::partPose(body, box);
  // The hinge holds the lower edge at the plate, but sharp edges rest at a gap of 0.1 um. The push therefore
  // raises the other edge, by a few times that gap.
  EXPECT_LE((after.p - before.p).norm(), 1e-7);
  EXPECT_NEAR(after.p.z(), 0.005, 4 * FeatureMotion::kRest_m);
  world.world->removeConstraint(&hinge);
}

TEST_P(JointsWithSolver, ACouplingPullsASliderAlongItsRailOnly) {
  World world(GetParam());
  world.world->setGravity(btVector3(0, 0, 0));
  const Built box = steelBox();
  btRigidBody& body = world.add(box, Pose());
  const Pose X_BP = box.frame.X_PB.inverse();
  btSliderConstraint slider(body, toBt(X_BP), true);  // along the part's x axis
  slider.setLowerLinLimit(-1);
  slider.setUpperLinLimit(1);
  slider.setLowerAngLimit(0);
  slider.setUpperAngLimit(0);
  world.world->addConstraint(&slider);
  CouplingGains gains;
  gains.k_N_per_m = 2000;
  gains.b_Ns_per_m = 2 * std::sqrt(2000 * box.frame.mass_kg);
  gains.k_Nm_per_rad = 2;
  gains.b_Nms_per_rad = 0.01;
  gains.max_force_N = gains.max_torque_Nm = 1000;
  CouplingConstraint coupling(body, X_BP, gains);
  world.world->addConstraint(&coupling, true);
  CouplingState target;
  target.is_coupled = true;
  target.X_W = Pose::translation(Vec3(3e-3, 2e-3, 0));
  coupling.setTarget(target);
  world.step(1000);
  const Pose X_WP = test::partPose(body, box);
  // Along the rail the part is at its target; across it the spring is stretched by 2 mm: 4 N. The erp of a
  // slider's rows leaves an error although their cfm is 0; the tolerances of some thousandths are larger than
  // that error.
  EXPECT_NEAR(X_WP.p.x(), 3e-3, 1e-6);
  EXPECT_NEAR(X_WP.p.y(), 0, 1e-5);
  EXPECT_NEAR(coupling.wrench().f.y(), 4, 0.02);
  EXPECT_NEAR(coupling.wrench().f.x(), 0, 0.01);
  world.world->removeConstraint(&coupling);
  world.world->removeConstraint(&slider);
}

TEST_P(JointsWithSolver, AJointBreaksAboveItsBreakingImpulse) {
  World world(GetParam());
  const Built box = steelBox();
  btRigidBody& body = world.add(box, Pose());
  btPoint2PointConstraint joint(body, inBody(box, Vec3::Zero()));
  joint.setBreakingImpulseThreshold(toBt(0.5 * box.frame.mass_kg * kGravity * 1e-3));
  world.world->addConstraint(&joint);
  world.step(100);
  EXPECT_FALSE(joint.isEnabled());
  EXPECT_LT(body.getWorldTransform().getOrigin().z(), -0.9 * kGravity * 0.1 * 0.1 / 2);
  world.world->removeConstraint(&joint);
}

// A free body would turn away from the axis; the hinge holds the body with the torque w x I w.
//
// A step takes the pose through a quaternion and back, which tilts it by some eight roundings of epsilon / 2.
// The joint corrects the share erp of the tilt in each step, so that tilts add up to 1 / erp of one step's
// tilt, and the speed of the correction is one step's tilt in the time of a step. With floats a third of this
// speed was measured.
TEST(Joints, ABodyThatSpinsAboutAnAxisThatIsNotPrincipalStaysOnItsHinge) {
  constexpr double kSpin_rad_s = 50, kStep_s = 1e-3;
  constexpr double kOff_rad_s =
      std::max(1e-6 * kSpin_rad_s, 4 * double{std::numeric_limits<btScalar>::epsilon()} / kStep_s);
  const Vec3 axis = Vec3(1, 0, 1).normalized();
  for (const SolverKind kind : {SolverKind::Constraint, SolverKind::Penalty}) {
    World world(kind);
    world.world->setGravity(btVector3(0, 0, 0));
    const Built box = steelBox();
    btRigidBody& body = world.add(box, Pose());
    body.setAngularVelocity(toBt(Vec3(kSpin_rad_s * axis)));
    btHingeConstraint hinge(body, inBody(box, Vec3::Zero()), axisInBody(box, axis));
    btJointFeedback feedback;
    hinge.setJointFeedback(&feedback);
    hinge.enableFeedback(true);
    world.world->addConstraint(&hinge);
    const Vec3 axis_B = box.frame.X_PB.R.transpose() * axis;
    const Vec3 I_axis = box.frame.inertia_kg_m2.cwiseProduct(axis_B);
    const double torque_Nm = axis_B.cross(I_axis).norm() * kSpin_rad_s * kSpin_rad_s;
    for (int i = 0; i < 200; ++i) {
      world.step();
      const Vec3 w = fromBt(body.getAngularVelocity());
      EXPECT_LE((w - w.dot(axis) * axis).norm(), kOff_rad_s) << test::nameOf(kind) << ", " << i;
      EXPECT_NEAR(w.dot(axis), kSpin_rad_s, 1e-3 * kSpin_rad_s) << test::nameOf(kind) << ", " << i;
      EXPECT_NEAR(fromBt(feedback.m_appliedTorqueBodyA).norm(), torque_Nm, 0.01 * torque_Nm)
          << test::nameOf(kind) << ", " << i;
      if (HasFailure()) break;
    }
    world.world->removeConstraint(&hinge);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, JointsWithSolver,
                         testing::Values(SolverKind::Stock, SolverKind::Constraint, SolverKind::Penalty),
                         [](const auto& info) { return test::nameOf(info.param); });

}  // namespace
}  // namespace vps::bullet
