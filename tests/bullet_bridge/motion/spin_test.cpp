// SPDX-License-Identifier: BSD-3-Clause
// Bodies that turn about an axis with room around it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bullet_bridge/world.h"
#include "support/lathe.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

constexpr double kBore_m = 5.025e-3, kShaft_m = 5e-3;
constexpr int kSides = 96;

/// A shaft in its bore, along z, that turns at 3000 rpm.
struct SpinningShaft {
  World world;
  btRigidBody* body = nullptr;

  explicit SpinningShaft(SolverKind solver) : world(solver) {
    static const Built bore = test::build(
        test::lathe({{kBore_m, -5e-3}, {9e-3, -5e-3}, {9e-3, 5e-3}, {kBore_m, 5e-3}}, kSides), 7850);
    static const Built shaft = test::build(
        test::lathe({{0, -12e-3}, {kShaft_m, -12e-3}, {kShaft_m, 12e-3}, {0, 12e-3}}, kSides), 7850);
    world.world->setGravity(btVector3(0, 0, 0));
    world.add(bore, Pose(), true, 0);
    body = &world.add(shaft, Pose(), false, 0);
    body->setAngularVelocity(btVector3(0, 0, toBt(100 * std::numbers::pi)));
  }
  [[nodiscard]] double aside_m() const {
    const btVector3& at = body->getWorldTransform().getOrigin();
    return std::hypot(at.x(), at.y());
  }
};

class Spin : public testing::TestWithParam<SolverKind> {};
INSTANTIATE_TEST_SUITE_P(With, Spin, testing::Values(SolverKind::Constraint, SolverKind::Stock),
                         [](const auto& info) { return test::nameOf(info.param); });

TEST_P(Spin, AShaftWithRoomAroundItTurnsAsIfItWereAlone) {
  SpinningShaft shaft(GetParam());
  for (int i = 0; i < 50; ++i) shaft.world.step();
  // The shaft's centre of mass is off the axis by rounding.
  const double epsilon = std::numeric_limits<btScalar>::epsilon();
  EXPECT_LT(shaft.aside_m(), 16 * epsilon * kShaft_m);
  EXPECT_NEAR(shaft.body->getAngularVelocity().z(), 100 * std::numbers::pi,
              50 * 100 * std::numbers::pi * epsilon);
}

// The shaft falls across its axis into the bore, which holds it.
TEST_P(Spin, AShaftThatLeavesItsAxisIsHeld) {
  SpinningShaft shaft(GetParam());
  for (int i = 0; i < 50; ++i) shaft.world.step();
  shaft.body->setGravity(btVector3(toBt(-9.81), 0, 0));
  shaft.body->activate();
  double farthest_m = 0;
  for (int i = 0; i < 100; ++i) {
    shaft.world.step();
    farthest_m = std::max(farthest_m, shaft.aside_m());
  }
  // Corners pass corners, so the clearance lies between the narrowest and the widest. In a step of 18 degrees
  // the height of a facet's corners is tolerated: a quarter of the margin, 5 um.
  EXPECT_GT(farthest_m, kBore_m * std::cos(std::numbers::pi / kSides) - kShaft_m);
  EXPECT_LT(farthest_m, kBore_m - kShaft_m + 5e-6);
}

// Two blocks hit the shaft in its middle from one side, which its own motion does not predict.
TEST(Spin, AShaftThatOthersHitIsHeld) {
  SpinningShaft shaft(SolverKind::Constraint);
  static const Built block = test::build(makeBox({2e-3, 2e-3, 2e-3}), 7850);
  for (int i = 0; i < 50; ++i) shaft.world.step();
  for (const double z_m : {-9e-3, 9e-3})
    shaft.world.add(block, Pose::translation({-kShaft_m - 1.5e-3, 0, z_m}), false, 0)
        .setLinearVelocity(btVector3(1, 0, 0));
  double farthest_m = 0;
  for (int i = 0; i < 30; ++i) {
    shaft.world.step();
    farthest_m = std::max(farthest_m, shaft.aside_m());
  }
  EXPECT_GT(farthest_m, 20e-6);
  EXPECT_LT(farthest_m, kBore_m - kShaft_m + 5e-6);
}

// Bullet's own solver solves islands with anisotropic friction, and calls no pair's check.
TEST(Spin, ABarThatTurnsFastMeetsAWallWithAnisotropicFriction) {
  World world(SolverKind::Constraint);
  world.world->setGravity(btVector3(0, 0, 0));
  const Built bar = test::build(makeBox({60e-3, 4e-3, 4e-3}), 7850, 0.5e-3, 1e-3),
              wall = test::build(makeBox({20e-3, 1e-3, 10e-3}), 7850, 0.25e-3, 0.5e-3);
  world.add(wall, Pose::translation({25e-3, 15e-3, 0}), true, 0)
      .setAnisotropicFriction(btVector3(1, toBt(0.5), 1));
  btRigidBody& body = world.add(bar, Pose(), false, 0);
  body.setAngularVelocity(btVector3(0, 0, 300));
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_LT(body.getAngularVelocity().length(), 200);
}

}  // namespace
}  // namespace vps::bullet
