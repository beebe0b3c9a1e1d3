// SPDX-License-Identifier: BSD-3-Clause
// Bodies that slide over seams and rims, or pass them at a distance: nothing is in the way.
#include <gtest/gtest.h>

#include <random>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

// In a step, gravity alone would take the block 10 um below the plate that it is about to reach.
TEST(Seam, ABlockSlidesOverALevelSeamAndDownASmallStep) {
  static const Built plate = test::build(makeBox({60e-3, 60e-3, 6e-3}), 7850, 0.5e-3, 1e-3),
                     block = test::build(makeBox({20e-3, 15e-3, 10e-3}), 7850, 0.5e-3, 1e-3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> from_m(0, 1e-3), aside_m(-5e-3, 5e-3), turn_rad(-0.1, 0.1);
  for (const double speed_m_s : {0.1, 1.0})
    for (const double step_m : {0.0, -0.05e-6, -2e-6})
      for (int i = 0; i < 5; ++i) {
        World world(SolverKind::Constraint);
        world.add(plate, Pose::translation({-30e-3, 0, -3e-3}), true, 0);
        world.add(plate, Pose::translation({30e-3, 0, -3e-3 + step_m}), true, 0);
        const Mat3 R = rotationFromVector(Vec3(0, 0, i == 0 ? 0 : turn_rad(random)));
        btRigidBody& body = world.add(
            block, Pose(R, Vec3(-12e-3 - from_m(random), aside_m(random), 5e-3 + 0.1e-6)), false, 0);
        body.setLinearVelocity(btVector3(toBt(speed_m_s), 0, 0));
        world.step(static_cast<int>(30e-3 / speed_m_s / 1e-3));
        const btVector3& v = body.getLinearVelocity();
        const double fall_m_s = 9.81 * -step_m / speed_m_s;  // what the way down may add
        EXPECT_NEAR(v.x(), speed_m_s, 1e-4 * speed_m_s + fall_m_s) << step_m << ' ' << i;
        EXPECT_LT(std::abs(body.getWorldTransform().getOrigin().z() - 5e-3), 5e-6) << step_m << ' ' << i;
      }
}

TEST(Seam, ABodyThatPassesARimAtADistanceKeepsItsVelocity) {
  static const Built plate = test::build(makeBox({60e-3, 60e-3, 6e-3}), 7850, 0.5e-3, 1e-3),
                     block = test::build(makeBox({20e-3, 15e-3, 10e-3}), 7850, 0.5e-3, 1e-3);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> from_m(0, 1e-3), aside_m(-5e-3, 5e-3), turn_rad(-0.1, 0.1);
  for (const double gap_m : {1e-6, 20e-6, 50e-6, 100e-6})
    for (int i = 0; i < 10; ++i) {
      World world(SolverKind::Constraint);
      world.world->setGravity(btVector3(0, 0, 0));
      world.add(plate, Pose::translation({30e-3, 0, -3e-3}), true, 0);
      const Mat3 R = rotationFromVector(Vec3(0, 0, turn_rad(random)));
      btRigidBody& body =
          world.add(block, Pose(R, Vec3(-12e-3 - from_m(random), aside_m(random), 5e-3 + gap_m)), false, 0);
      body.setLinearVelocity(btVector3(1, 0, 0));
      world.step(30);
      EXPECT_LT((body.getLinearVelocity() - btVector3(1, 0, 0)).length(), 1e-6) << gap_m << ' ' << i;
    }
}

}  // namespace
}  // namespace vps::bullet
