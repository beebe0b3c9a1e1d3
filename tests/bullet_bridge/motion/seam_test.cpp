// SPDX-License-Identifier: BSD-3-Clause
// Bodies slide over seams and rims, or pass them at a distance, without being stopped.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bullet_bridge/world.h"
#include "vps/feature_motion.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

/// A block in front of a rim along y, at x = 0, turned by up to 0.1 rad.
class Slide {
 public:
  explicit Slide(unsigned seed) : random_(seed) {}

  static void addPlate(World& world, double from_x_m, double top_m) {
    static const Built plate = test::build(makeBox({60e-3, 60e-3, 6e-3}), 7850, 0.5e-3, 1e-3);
    world.add(plate, Pose::translation({from_x_m + 30e-3, 0, top_m - 3e-3}), true, 0);
  }
  btRigidBody& addBlock(World& world, double gap_m, double speed_m_s, bool is_parallel = false) {
    static const Built block = test::build(makeBox({20e-3, 15e-3, 10e-3}), 7850, 0.5e-3, 1e-3);
    const double turn_rad = is_parallel ? 0 : 0.1 * draw_(random_), from_m = 0.5e-3 * (1 + draw_(random_));
    btRigidBody& body = world.add(block,
                                  Pose(rotationFromVector(Vec3(0, 0, turn_rad)),
                                       Vec3(-12e-3 - from_m, 5e-3 * draw_(random_), 5e-3 + gap_m)),
                                  false, 0);
    body.setLinearVelocity(btVector3(toBt(speed_m_s), 0, 0));
    return body;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> draw_{-1, 1};
};

// In a step, gravity alone would take the block 10 um below the plate that it is about to reach.
TEST(Seam, ABlockSlidesOverALevelSeamAndDownASmallStep) {
  Slide slide(1);
  for (const double speed_m_s : {0.1, 1.0})
    for (const double step_m : {0.0, -0.05e-6, -2e-6})
      for (int i = 0; i < 5; ++i) {
        World world(SolverKind::Constraint);
        Slide::addPlate(world, -60e-3, 0);
        Slide::addPlate(world, 0, step_m);
        const btRigidBody& body = slide.addBlock(world, FeatureMotion::kRest_m, speed_m_s, i == 0);
        world.step(static_cast<int>(30e-3 / speed_m_s / 1e-3));
        const double fall_m_s = 9.81 * -step_m / speed_m_s;  // speed that the descent may add
        EXPECT_NEAR(body.getLinearVelocity().x(), speed_m_s, 1e-4 * speed_m_s + fall_m_s)
            << step_m << ' ' << i;
        EXPECT_LT(std::abs(body.getWorldTransform().getOrigin().z() - 5e-3), 5e-6) << step_m << ' ' << i;
      }
}

TEST(Seam, ABodyThatPassesARimAtADistanceKeepsItsVelocity) {
  Slide slide(2);
  for (const double gap_m : {1e-6, 20e-6, 50e-6, 100e-6})
    for (int i = 0; i < 10; ++i) {
      World world(SolverKind::Constraint);
      world.world->setGravity(btVector3(0, 0, 0));
      Slide::addPlate(world, 0, 0);
      const btRigidBody& body = slide.addBlock(world, gap_m, 1);
      world.step(30);
      EXPECT_LT((body.getLinearVelocity() - btVector3(1, 0, 0)).length(), 1e-6) << gap_m << ' ' << i;
    }
}

}  // namespace
}  // namespace vps::bullet
