// SPDX-License-Identifier: BSD-3-Clause
// Penalty contact: a spring and a bristle at every touching point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_bridge/world.h"
#include "vps_bullet/log.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::kGravity;
using test::kIsDouble;
using test::plate;
using test::SolverKind;
using test::steelBox;
using test::World;

TEST(Penalty, ABlockSinksByItsWeightOverStiffnessAndArea) {
  Settings settings;
  settings.stiffness_N_per_m3 = 1e9;
  settings.sides = Sides::One;
  World world(SolverKind::Penalty, settings);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  world.step(1000);
  const double sunk_m = 0.005 - body.getWorldTransform().getOrigin().z();
  // The lower face has 300 mm^2. Points on its rim, 70 mm long, also represent half a spacing of the sides.
  const double weight_N = box.frame.mass_kg * kGravity;
  EXPECT_GE(sunk_m, 0.99 * weight_N / (1e9 * 335e-6));
  EXPECT_LE(sunk_m, 1.01 * weight_N / (1e9 * 300e-6));
}

TEST(Penalty, FrictionHoldsWithoutCreep) {
  constexpr double kMu = 0.3;
  const double angle_rad = std::atan(0.97 * kMu);
  const Mat3 R = rotationFromVector(Vec3(0.3, 0.95, 0).normalized() * angle_rad);
  World world(SolverKind::Penalty);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose(R, R * Vec3(0, 0, -0.005)), true, kMu);
  btRigidBody& body = world.add(box, Pose(R, R * Vec3(0, 0, 0.005)), false, kMu);
  world.step(1000);
  const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
  world.step(10000);
  // The friction bristle of a penalty point is a spring: nothing moves once it is deflected, except by
  // rounding, 1e-16 of a position in each step.
  EXPECT_LE((fromBt(body.getWorldTransform().getOrigin()) - start).norm(), 1e-11);
}

TEST(Penalty, ImpulsesInTheManifoldsAddUpToTheWeight) {
  World world(SolverKind::Penalty);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  world.step(500);
  double sum_Ns = 0;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i)
      sum_Ns += manifold.getContactPoint(i).m_appliedImpulse;
  }
  const double weight_Ns = box.frame.mass_kg * kGravity * 1e-3;
  EXPECT_NEAR(sum_Ns, weight_Ns, 1e-6 * weight_Ns);
}

TEST(Penalty, APartAtRestIsNotQueriedAgainUntilItIsPushed) {
  World world(SolverKind::Penalty);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  world.step(500);
  const std::size_t updates = stats(world.dispatcher).pair_updates;
  world.step(100);
  EXPECT_EQ(stats(world.dispatcher).pair_updates, updates);
  body.setLinearVelocity(btVector3(toBt(0.1), 0, 0));
  world.step();
  EXPECT_EQ(stats(world.dispatcher).pair_updates, updates + 1);
}

TEST(Penalty, ABlockRidesOnAMovingPlateWithoutFurtherQueries) {
  if (!kIsDouble) GTEST_SKIP() << "the plate's speed is a difference of places, 0.1 mm/s apart in floats";
  constexpr double kSpeed_m_s = 0.1;
  World world(SolverKind::Penalty);
  const Built box = steelBox(), ground = plate();
  btRigidBody& below = world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  below.setCollisionFlags(below.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  btDefaultMotionState motion(below.getWorldTransform());
  below.setMotionState(&motion);
  body.setLinearVelocity(btVector3(toBt(kSpeed_m_s), 0, 0));
  const auto ride = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      motion.m_graphicsWorldTrans.getOrigin() += btVector3(toBt(1e-3 * kSpeed_m_s), 0, 0);
      world.step();
    }
    return fromBt(below.getWorldTransform()).inverse() * fromBt(body.getWorldTransform());
  };
  const Pose before = ride(500);
  const std::size_t updates = stats(world.dispatcher).pair_updates;
  const Pose after = ride(1000);
  EXPECT_EQ(stats(world.dispatcher).pair_updates, updates);
  // Bullet computes the plate's speed as a difference of positions, so the tolerance is the rounding of 1000
  // steps. If the penalty points did not move with the plate, they would be 100 mm off and the block would
  // fall over.
  EXPECT_LE((after.p - before.p).norm(), 1e-12);
  EXPECT_LE((after.R - before.R).norm(), 1e-12);
  below.setMotionState(nullptr);
}

TEST(Penalty, ABallAtRestThatGrowsIsRaised) {
  constexpr double kRadius_m = 5e-3, kGrown_m = 6e-3;
  World world(SolverKind::Penalty);
  const Built ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btSphereShape ball(toBt(kRadius_m));
  btRigidBody& body =
      world.addShape(ball, 4e-3, Vec3::Constant(4e-8), Pose::translation(Vec3(0, 0, kRadius_m)));
  world.step(2000);
  const std::size_t updates = stats(world.dispatcher).pair_updates;
  world.step();
  ASSERT_EQ(stats(world.dispatcher).pair_updates, updates);
  ball.setUnscaledRadius(toBt(kGrown_m));
  world.step(200);
  // The ball touches the plate at the plate's points, 1 mm apart, and sinks by up to s^2 / (4 r) between
  // them.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kGrown_m, 1e-6 / (4 * kRadius_m));
}

TEST(Penalty, PartsThatStartInsideEachOtherSeparateGently) {
  World world(SolverKind::Penalty);
  world.world->setGravity(btVector3(0, 0, 0));
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005 - 1e-3)));
  double fastest_m_s = 0;
  for (int i = 0; i < 200; ++i) {
    world.step();
    fastest_m_s = std::max<double>(fastest_m_s, body.getLinearVelocity().length());
  }
  // The overlap is released at 0.05 m/s. The 50 um of a step are pressed out at once, which at most doubles
  // the speed.
  EXPECT_LE(fastest_m_s, 0.1);
  EXPECT_GE(body.getWorldTransform().getOrigin().z(), 0.005 - 1e-6);
}

TEST(Penalty, SupportsAStockBoxInTheIslandToo) {
  World world(SolverKind::Penalty);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  btBoxShape small(btVector3(toBt(0.004), toBt(0.004), toBt(0.004))),
      lid(btVector3(toBt(0.003), toBt(0.003), toBt(0.003)));
  const double inertia = 0.01 * 0.008 * 0.008 / 6;
  btRigidBody& lower =
      world.addShape(small, 0.01, Vec3::Constant(inertia), Pose::translation(Vec3(0, 0, 0.0141)));
  btRigidBody& upper =
      world.addShape(lid, 0.01, Vec3::Constant(inertia), Pose::translation(Vec3(0, 0, 0.0213)));
  world.step(1000);
  // Bullet's own box on box has the tolerance of its margins: a tenth of a millimetre at most.
  EXPECT_NEAR(lower.getWorldTransform().getOrigin().z(), 0.014, 1e-6);
  EXPECT_NEAR(upper.getWorldTransform().getOrigin().z(), 0.021, 1e-4);
  world.step(1000);
  EXPECT_LE(upper.getLinearVelocity().length(), 1e-6);
}

TEST(Penalty, TwoRunsGiveTheSameBits) {
  const Built box = steelBox(), ground = plate();
  btVector3 end[2];
  for (btVector3& p : end) {
    World world(SolverKind::Penalty);
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
    btRigidBody& body = world.add(box, Pose(rotationFromVector(Vec3(0.2, 0.1, 0.3)), Vec3(0, 0, 0.02)));
    world.step(300);
    p = body.getWorldTransform().getOrigin();
  }
  EXPECT_EQ(end[0], end[1]);
}

TEST(Penalty, AStockSolverTakesTheContactsAsRigidAndIsReported) {
  Settings settings;
  settings.contact_method = ContactMethod::Penalty;
  World world(SolverKind::Stock, settings);
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  const btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.00501)));
  testing::internal::CaptureStderr();
  world.step(200);
  const std::string message = testing::internal::GetCapturedStderr();
  EXPECT_NE(message.find("is not bullet::Solver"), std::string::npos) << message;
  EXPECT_EQ(message.find("is Penalty"), message.rfind("is Penalty")) << "reported more than once";
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.005, 1e-6);
}

/// A heap of boxes of 5,900 points each, in which more points touch than are solved one by one.
class PenaltyHeap : public testing::Test {
 protected:
  static constexpr std::size_t kLimit = 500;
  PenaltyHeap() {
    setLogHook([this](LogLevel, const std::string& message) { said_.push_back(message); });
    world_ =
        std::make_unique<World>(SolverKind::Penalty, Settings{}, 100, SolverSettings{.point_limit = kLimit});
    static const Built box = test::build(makeBox(Vec3(0.02, 0.015, 0.01)), 7850, 0.25e-3, 0.5e-3);
    world_->addShape(ground_, 0, Vec3::Zero(), Pose());
    for (int i = 0; i < 6; ++i)
      world_->add(box, Pose(rotationFromVector(Vec3(0.3 * i, 0.2, 0.1 * i)),
                            Vec3(i % 2 ? 0.006 : -0.006, i & 2 ? 0.006 : -0.006, 0.02 + 0.015 * i)));
  }
  ~PenaltyHeap() override {
    world_.reset();
    setLogHook({});
  }
  const Solver& solver() const { return static_cast<const Solver&>(*world_->solver_); }
  btStaticPlaneShape ground_{btVector3(0, 0, 1), 0};
  std::unique_ptr<World> world_;
  std::vector<std::string> said_;
};

TEST_F(PenaltyHeap, SolvesNoMorePointsThanItsLimitAndSaysSoOnce) {
  std::size_t most_near = 0, most_solved = 0;
  for (int i = 0; i < 400; ++i) {
    world_->step();
    most_near = std::max(most_near, solver().pointsNear());
    most_solved = std::max(most_solved, solver().pointsSolved());
  }
  EXPECT_GT(most_near, 4 * kLimit) << "the heap is large enough for this test";
  EXPECT_LE(most_solved, kLimit);
  EXPECT_EQ(std::count_if(said_.begin(), said_.end(),
                          [](const std::string& m) { return m.find("point_limit") != std::string::npos; }),
            1);
  for (const auto& body : world_->bodies) {
    if (!body->isStaticObject()) {
      EXPECT_GT(body->getWorldTransform().getOrigin().z(), 0.0049) << "none sinks into the ground";
    }
  }
}

TEST(Penalty, GroupsOfPointsCarryTheWeightAndHoldByFriction) {
  constexpr double kMu = 0.3;
  const double angle_rad = std::atan(0.97 * kMu);
  const Mat3 R = rotationFromVector(Vec3(0.3, 0.95, 0).normalized() * angle_rad);
  World world(SolverKind::Penalty, {}, 100, SolverSettings{.point_limit = 100});
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose(R, R * Vec3(0, 0, -0.005)), true, kMu);
  btRigidBody& body = world.add(box, Pose(R, R * Vec3(0, 0, 0.005)), false, kMu);
  world.step(1000);
  const auto& solver = static_cast<const Solver&>(*world.solver_);
  EXPECT_GT(solver.pointsNear(), 400u);
  EXPECT_LE(solver.pointsSolved(), 100u);
  const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
  world.step(1000);
  const Vec3 end = fromBt(body.getWorldTransform().getOrigin());
  EXPECT_LE((end - start).norm(), kIsDouble ? 1e-11 : 5e-6);
  EXPECT_NEAR((R.transpose() * end).z(), 0.005, 1e-7);
}

TEST(Penalty, RefusesAStiffnessThatIsNotPositiveAndFinite) {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  for (const double k : {0.0, -1.0, std::nan("")}) {
    Settings settings;
    settings.stiffness_N_per_m3 = k;
    EXPECT_THROW(install(dispatcher, settings), std::invalid_argument);
  }
}

}  // namespace
}  // namespace vps::bullet
