// SPDX-License-Identifier: BSD-3-Clause The method of multipliers for rigid contacts, tested by the laws of
// contact and on problems for which sweeps would take very long.
#include "solver/rigid/contact_newton.h"

#include <gtest/gtest.h>

#include "bullet_bridge/small_island.h"

namespace vps::bullet {
namespace {

using namespace test_island;

constexpr double kNear_m_s = 1e-9;
constexpr int kMany = 2000;
constexpr std::uint64_t kSeeds = 40;

bool solveCone(SmallIsland& made) {
  ContactNewton newton(made.island, made.joints);
  const bool is_converged = newton.solve(made.sweeps.contacts(), kNear_m_s, kMany).is_converged;
  made.sweeps.applyImpulses();
  return is_converged;
}

TEST(ContactNewton, WithoutFrictionFindsTheNearestVelocitiesThatObeyAllContacts) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SmallIsland made;
    makeRandom(made, seed, 0);
    ASSERT_TRUE(solveCone(made)) << seed;
    const std::vector<Vec6> exact = bruteForce(made);
    ASSERT_FALSE(exact.empty()) << seed;
    EXPECT_LE(difference_m_s(made.solved(), exact), 1e-6) << seed;
  }
}

TEST(ContactNewton, ObeysSignoriniAndCoulombWhereItSaysThatItHasConverged) {
  int converged = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    SmallIsland made;
    makeRandom(made, seed, 0.4);
    if (!solveCone(made)) continue;
    ++converged;
    made.expectLaws(1e-6);
  }
  EXPECT_GE(converged, static_cast<int>(kSeeds) * 9 / 10);
}

TEST(ContactNewton, NeverAddsEnergy) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    for (const double mu : {0.0, 0.4}) {
      SmallIsland made;
      makeRandom(made, seed, mu);
      if (!solveCone(made)) continue;
      EXPECT_LE(made.energy_J(made.solved()), made.energy_J(made.free) * (1 + 1e-6)) << seed << ' ' << mu;
    }
}

// Contacts need a little more impulse than they had, as after a check. The solution must meet the laws of
// contact, and the bodies' velocities must be those of the impulses.
TEST(ContactNewton, TheVelocitiesOfTheImpulsesObeyTheLawsAsWell) {
  constexpr double kResidual_m_s = 1e-5;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SmallIsland made;
    makeRandom(made, seed, 0);
    ASSERT_TRUE(solveCone(made)) << seed;
    for (RigidContact& c : made.sweeps.contacts()) c.target_m_s += 0.05 * kResidual_m_s;
    ContactNewton newton(made.island, made.joints);
    ASSERT_TRUE(newton.solve(made.sweeps.contacts(), kResidual_m_s, kMany).is_converged) << seed;
    made.sweeps.applyImpulses();
    const std::vector<Vec6> u = made.solved();
    // A tenth of the residual by the law, and that of each body by its imbalance.
    for (const RigidContact& c : made.sweeps.contacts()) {
      const double v = c.normal.velocity([&](int body) { return u[static_cast<std::size_t>(body)]; });
      EXPECT_GE(v, c.target_m_s - 2.1 * kResidual_m_s) << seed;
      if (c.p_n > 0) {
        EXPECT_LE(v, c.target_m_s + 2.1 * kResidual_m_s) << seed;
      }
    }
  }
}

// A heavy block on a light one: each sweep transmits only a thousandth of the load.
TEST(ContactNewton, CarriesAHeavyBodyOnALightOne) {
  constexpr double kRatio = 1e4, kGravity_m_s2 = 9.81;
  SmallIsland made;
  btRigidBody& low = made.add(0.01, Vec3(0, 0, 5e-3), Vec3::Zero());
  btRigidBody& high = made.add(0.01 * kRatio, Vec3(0, 0, 15e-3), Vec3::Zero());
  for (btRigidBody* body : {&low, &high})
    body->applyCentralForce(btVector3(0, 0, toBt(-kGravity_m_s2 / static_cast<double>(body->getInvMass()))));
  for (const double x : {-5e-3, 5e-3})
    for (const double y : {-5e-3, 5e-3}) {
      made.touch(low, made.floor, Vec3(x, y, 0), Vec3(0, 0, 1), 0, 0.3);
      made.touch(high, low, Vec3(x, y, 10e-3), Vec3(0, 0, 1), 0, 0.3);
    }
  made.start();
  ASSERT_TRUE(solveCone(made));
  for (const Vec6& u : made.solved()) EXPECT_LE(u.norm(), 1e-6);
  double floor_Ns = 0;
  for (std::size_t k = 0; k < made.given.size(); ++k)
    if (made.given[k].body[1] == &made.floor) floor_Ns += made.sweeps.contacts()[k].p_n;
  EXPECT_NEAR(floor_Ns / (0.01 * (1 + kRatio) * kGravity_m_s2 * kDt_s), 1, 1e-4);
}

}  // namespace
}  // namespace vps::bullet
