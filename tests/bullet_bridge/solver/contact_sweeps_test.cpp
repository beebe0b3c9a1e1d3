// SPDX-License-Identifier: BSD-3-Clause
// Sweeps over rigid contacts without restitution, tested by the laws of contact and on problems with known
// solutions.
#include "solver/rigid/contact_sweeps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_bridge/small_island.h"

namespace vps::bullet {
namespace {

using namespace test_island;

constexpr double kConverged_m_s = 1e-13;
constexpr int kManySweeps = 200'000;
constexpr std::uint64_t kSweepSeeds = 40;

TEST(ContactSweeps, WithoutFrictionFindTheNearestVelocitiesThatObeyAllContacts) {
  for (std::uint64_t seed = 1; seed <= kSweepSeeds; ++seed) {
    SmallIsland made;
    makeRandom(made, seed, 0);
    ASSERT_TRUE(made.sweeps.sweep(kConverged_m_s, kManySweeps).is_converged) << seed;
    const std::vector<Vec6> exact = bruteForce(made);
    ASSERT_FALSE(exact.empty()) << seed;
    EXPECT_LE(difference_m_s(made.solved(), exact), 1e-8) << seed;
  }
}

TEST(ContactSweeps, ObeySignoriniAndCoulomb) {
  for (std::uint64_t seed = 1; seed <= kSweepSeeds; ++seed) {
    SCOPED_TRACE(seed);
    SmallIsland made;
    makeRandom(made, seed, 0.4);
    ASSERT_TRUE(made.sweeps.sweep(kConverged_m_s, kManySweeps).is_converged);
    made.expectLaws(1e-9);
  }
}

// Contacts whose gap is at most a step's travel can only dissipate energy, since the state of rest obeys all
// of them.
TEST(ContactSweeps, NeverAddEnergy) {
  for (std::uint64_t seed = 1; seed <= kSweepSeeds; ++seed)
    for (const double mu : {0.0, 0.4, 2.0}) {
      SmallIsland made;
      makeRandom(made, seed, mu);
      made.sweeps.sweep(kConverged_m_s, kManySweeps);
      EXPECT_LE(made.energy_J(made.solved()), made.energy_J(made.free) * (1 + 1e-12)) << seed << ' ' << mu;
    }
}

TEST(ContactSweeps, KeepLinearAndAngularMomentumOfBodiesThatOnlyTouchEachOther) {
  for (std::uint64_t seed = 1; seed <= kSweepSeeds; ++seed) {
    test::Random random(seed);
    SmallIsland made;
    for (int k = 0; k < 2; ++k)
      made.add(random.logUniform(0.001, 10), random.inBox(Vec3::Constant(0.02)),
               random.inBox(Vec3::Constant(2)), random.inBox(Vec3::Constant(100)), random.rotation());
    for (int i = 0; i < 4; ++i)
      made.touch(made.bodies[0], made.bodies[1], random.inBox(Vec3::Constant(0.02)), random.direction(), 0,
                 0.3);
    made.start();
    made.sweeps.sweep(1e-9, 30);  // whatever the impulses
    const Vec6 before = made.momentum(made.free), after = made.momentum(made.solved());
    EXPECT_LE((after - before).norm(), 1e-12 * before.norm()) << seed;
  }
}

// A ball falls at v along one wall of a groove of two walls at 45 degrees. The ball keeps only the velocity
// along the groove.
TEST(ContactSweeps, ABodyInAGrooveKeepsItsVelocityAlongIt) {
  SmallIsland made;
  made.add(0.1, Vec3::Zero(), Vec3(0.3, 0.7, -1));
  for (const double side : {-1.0, 1.0})
    made.touch(made.bodies[0], made.floor, Vec3::Zero(), Vec3(0, side, 1).normalized(), 0, 0);
  made.start();
  made.sweeps.sweep(kConverged_m_s, kManySweeps);
  // The engine holds the velocity along the groove rounded; across it, the walls' normals mirror each other.
  EXPECT_LE((made.solved()[0] - stacked(Vec3::Zero(), Vec3(0.3, 0, 0))).norm(),
            std::max(1e-10, 0.3 * kRounding));
}

// Two blocks that hit without restitution continue together.
TEST(ContactSweeps, AnImpactWithoutRestitutionEndsAtTheCommonVelocity) {
  for (const double ratio : {1e-3, 1.0, 1e3}) {
    SmallIsland made;
    made.add(0.1, Vec3(-5e-3, 0, 0), Vec3(1, 0, 0));
    made.add(0.1 * ratio, Vec3(5e-3, 0, 0), Vec3::Zero());
    made.touch(made.bodies[1], made.bodies[0], Vec3::Zero(), Vec3(1, 0, 0), 0, 0.3);
    made.start();
    made.sweeps.sweep(kConverged_m_s, kManySweeps);
    // The engine rounds both masses and then their inverses. An error d of the ratio r changes the velocity
    // by r / (1 + r)^2 d, at most a quarter of d.
    for (const Vec6& u : made.solved())
      EXPECT_NEAR(u[3], 1 / (1 + ratio), std::max(1e-12, 4 * kRounding / 4)) << ratio;
  }
}

// The body moves exactly by the gap and ends the step in touch.
TEST(ContactSweeps, ABodyMayUseUpItsGap) {
  SmallIsland made;
  made.add(0.1, Vec3::Zero(), Vec3(0, 0, -1));
  made.touch(made.bodies[0], made.floor, Vec3::Zero(), Vec3(0, 0, 1), 0.4e-3, 0);
  made.start();
  made.sweeps.sweep(kConverged_m_s, kManySweeps);
  // The engine rounds the gap and the time of the step.
  EXPECT_NEAR(made.solved()[0][5], -0.4, std::max(1e-12, 0.4 * 2 * kRounding));
}

}  // namespace
}  // namespace vps::bullet
