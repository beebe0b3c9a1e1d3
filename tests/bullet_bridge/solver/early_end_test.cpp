// SPDX-License-Identifier: BSD-3-Clause
// Shortened steps: the end of a step whose rounds of checks were used up. The pairs are mocks, which compute
// by a formula how deep their bodies would be.
#include "solver/rigid/contact_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "bullet_bridge/small_island.h"
#include "bullet_bridge/world.h"
#include "solver/contact_stores.h"

namespace vps::bullet {
namespace {

using test_island::kDt_s;
using test_island::SmallIsland;

/// A pair with one gap, which is linear in the displacement from the present poses.
class FakeCheck : public StepCheck {
 public:
  using Gap = std::function<double(const Pose (&X_WB)[2])>;
  FakeCheck(const btCollisionObject& a, const btCollisionObject& b, Gap gap)
      : object_{&a, &b}, gap_(std::move(gap)) {
    const Pose X_WB[2] = {fromBt(a.getWorldTransform()), fromBt(b.getWorldTransform())};
    start_m_ = gap_(X_WB);
  }
  [[nodiscard]] const btCollisionObject* object(int i) const override { return object_[i]; }
  void linearise(const Pose (&)[2], std::vector<MissedContact>&) override {}
  void findMissed(const Pose (&)[2], CheckRound, std::vector<MissedContact>& out) override {
    ++rounds;
    if (!missed) return;
    MissedContact m;
    m.point = missed;
    for (int i = 0; i < 2; ++i) m.object[i] = object_[i];
    m.end_gap_m = m.kept_m = 1;  // a row without effect
    out.push_back(m);
  }
  double freeShare(const Pose (&)[2]) override { return 1; }
  double freeShareOfPoints(const Pose (&X_WB)[2]) override {
    const double end_m = gap_(X_WB);
    if (end_m >= std::min(start_m_, 0.0) - kSlack_m) return 1;
    return std::max(start_m_, kSlack_m) / (start_m_ - end_m);
  }
  void endStep() override {}

  static constexpr double kSlack_m = 1e-6;
  btManifoldPoint* missed = nullptr;  ///< contact that is reported as missed in every check
  int rounds = 0;

 private:
  const btCollisionObject* object_[2];
  Gap gap_;
  double start_m_ = 0;
};

double heightOf(const Pose& X_WB) {
  return X_WB.p.z();
}

TEST(EarlyEnd, AStepThatStaysFreeIsLeftAsItIs) {
  SmallIsland made;
  btRigidBody& body = made.add(1, Vec3(0, 0, 1e-3), Vec3(0, 0, -0.5));
  made.start();
  FakeCheck check(body, made.floor, [](const Pose(&X)[2]) { return heightOf(X[0]); });
  StepCheck* const checks[] = {&check};
  EXPECT_FALSE(endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s));
  EXPECT_EQ(made.island.bodies[0].way_share, 1);
}

TEST(EarlyEnd, ABodyEndsBeforeTheFloorAndKeepsItsVelocity) {
  SmallIsland made;
  btRigidBody& body = made.add(1, Vec3(0, 0, 1e-3), Vec3(0, 0, -3), Vec3(0, 40, 0));
  made.start();
  const Vec6 u = made.island.bodies[0].u;
  FakeCheck check(body, made.floor, [](const Pose(&X)[2]) { return heightOf(X[0]); });
  StepCheck* const checks[] = {&check};
  EXPECT_TRUE(endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s));
  const double end_m = made.island.endPose(&body, {}, kDt_s).p.z();
  EXPECT_GE(end_m, 0);
  EXPECT_LE(end_m, 0.2e-3);
  EXPECT_EQ(made.island.bodies[0].u, u);
  std::vector<BodyEnd> ends;
  made.island.readEnds({}, kDt_s, ends);
  EXPECT_NEAR((ends[0].v.tail<3>() - u.tail<3>()).norm(), 0, 1e-12);
  made.island.finish({}, kDt_s, ends);
  // Bullet then moves the body by its velocity.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z() + kDt_s * body.getLinearVelocity().z(), end_m, 1e-9);
  EXPECT_NEAR(body.getLinearVelocity().z(), -3, 1e-6);
}

// One body hits the floor, another one rests on it with load, and a third one touches neither.
TEST(EarlyEnd, OnlyWhatHangsTogetherEndsEarly) {
  SmallIsland made;
  btRigidBody& low = made.add(1, Vec3(0, 0, 1e-3), Vec3(0, 0, -3));
  btRigidBody& high = made.add(1, Vec3(0, 0, 11e-3), Vec3(0, 0, -4));
  made.add(1, Vec3(1, 0, 0), Vec3(0, 0, -3));
  made.touch(high, low, Vec3(0, 0, 6e-3), Vec3::UnitZ(), 0, 0);
  made.start();
  ASSERT_TRUE(made.sweeps.sweep(1e-9, 100).is_converged);
  ASSERT_GT(made.sweeps.contacts()[0].p_n, 0);
  FakeCheck check(low, made.floor, [](const Pose(&X)[2]) { return heightOf(X[0]); });
  StepCheck* const checks[] = {&check};
  EXPECT_TRUE(endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s));
  EXPECT_LT(made.island.bodies[0].way_share, 0.5);
  EXPECT_EQ(made.island.bodies[1].way_share, made.island.bodies[0].way_share);
  EXPECT_EQ(made.island.bodies[2].way_share, 1);
}

// Two bodies, each with its own floor; the overlap of the second body is found only after the first body has
// stopped.
TEST(EarlyEnd, IsLookedAtAgain) {
  SmallIsland made;
  btRigidBody& left = made.add(1, Vec3(0, 0, 1e-3), Vec3(0, 0, -3));
  btRigidBody& right = made.add(1, Vec3(1, 0, 1e-3), Vec3(0, 0, -3));
  made.start();
  // The right body has room only after the left one has moved.
  FakeCheck floor(left, made.floor, [](const Pose(&X)[2]) { return heightOf(X[0]); });
  FakeCheck pair(right, left, [](const Pose(&X)[2]) { return heightOf(X[0]) - heightOf(X[1]) + 1e-4; });
  StepCheck* const checks[] = {&floor, &pair};
  EXPECT_TRUE(endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s));
  const double left_m = made.island.endPose(&left, {}, kDt_s).p.z(),
               right_m = made.island.endPose(&right, {}, kDt_s).p.z();
  EXPECT_GE(left_m, 0);
  EXPECT_GE(right_m, left_m - 1e-4 - FakeCheck::kSlack_m);
}

// A body that is deep before the step is not held for ever.
TEST(EarlyEnd, WhatIsJammedGoesOn) {
  SmallIsland made;
  btRigidBody& body = made.add(1, Vec3(0, 0, -5e-6), Vec3(0.2, 0, -0.01));
  made.start();
  FakeCheck check(body, made.floor, [](const Pose(&X)[2]) { return heightOf(X[0]); });
  StepCheck* const checks[] = {&check};
  EXPECT_TRUE(endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s));
  EXPECT_GT(made.island.bodies[0].way_share, 0.05);
  EXPECT_GE(made.island.endPose(&body, {}, kDt_s).p.z(), -5e-6 - FakeCheck::kSlack_m);
}

// A plate that the solver does not move comes down on a body: no share of the body's own way helps.
TEST(EarlyEnd, ABodyIsNotStoppedForWhatComesToIt) {
  SmallIsland made;
  btRigidBody& body = made.add(1, Vec3(0, 0, 0), Vec3(0.2, 0, 0));
  made.floor.setCollisionFlags(made.floor.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  made.floor.setWorldTransform(toBt(Pose::translation({0, 0, 0.1e-3})));
  made.floor.setLinearVelocity(btVector3(0, 0, -1));
  made.start();
  FakeCheck check(body, made.floor, [](const Pose(&X)[2]) { return heightOf(X[1]) - heightOf(X[0]); });
  StepCheck* const checks[] = {&check};
  endEarly(made.island, made.sweeps.contacts(), made.joints, checks, {}, kDt_s);
  EXPECT_GT(made.island.bodies[0].way_share, 0);
}

// An early end in a whole world, where a pair that always reports a missed contact uses up the rounds.
TEST(EarlyEnd, ASolversStepEndsWherePointsAreNotDeep) {
  static const test::Built box = test::steelBox(), plate = test::plate();
  test::World scene;
  scene.world->setGravity(btVector3(0, 0, 0));
  scene.add(plate, Pose::translation({0, 0, -5e-3}), true);
  btRigidBody& high = scene.add(box, Pose::translation({0, 0, 5.1e-3}));
  scene.step();
  StepChecks& checks = *contactFunctionOf(&scene.dispatcher)->step_checks;
  btPersistentManifold* manifold = nullptr;
  for (int i = 0; i < scene.dispatcher.getNumManifolds(); ++i)
    if (checks.find(scene.dispatcher.getManifoldByIndexInternal(i)))
      manifold = scene.dispatcher.getManifoldByIndexInternal(i);
  ASSERT_TRUE(manifold);
  high.setLinearVelocity(btVector3(0, 0, btScalar(2)));  // away from the plate, to an invisible lid
  const double start_m = double(high.getWorldTransform().getOrigin().z());
  FakeCheck check(*manifold->getBody0(), *manifold->getBody1(),
                  [&](const Pose(&X)[2]) { return start_m + 0.5e-3 - std::max(X[0].p.z(), X[1].p.z()); });
  btManifoldPoint point;
  point.m_normalWorldOnB = btVector3(0, 0, 1);
  point.m_lateralFrictionDir1 = btVector3(1, 0, 0);
  point.m_lateralFrictionDir2 = btVector3(0, 1, 0);
  check.missed = &point;
  StepCheck* const real = checks.find(manifold);
  checks.add(manifold, &check);
  const auto& solver = dynamic_cast<const Solver&>(*scene.solver_);
  const std::size_t before = solver.shortenedSteps();
  scene.step();
  EXPECT_EQ(solver.shortenedSteps(), before + 1);
  EXPECT_EQ(check.rounds, 8);
  const double way_m = double(high.getWorldTransform().getOrigin().z()) - start_m;
  EXPECT_LE(way_m, 0.5e-3);
  EXPECT_GE(way_m, 0.3e-3);
  EXPECT_NEAR(double(high.getLinearVelocity().z()), 2, 1e-6);
  checks.add(manifold, real);
}

}  // namespace
}  // namespace vps::bullet
