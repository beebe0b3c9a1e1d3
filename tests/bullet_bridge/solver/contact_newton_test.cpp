// SPDX-License-Identifier: BSD-3-Clause
// The method of multipliers for rigid contacts: the laws of contact, problems for which sweeps would take
// very long, and many bodies at once with known impulses.
#include "solver/rigid/contact_newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

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
// contact, and the bodies' velocities must follow from the impulses.
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
    // The law may be violated by a tenth of the residual, and each body's velocity by its imbalance.
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

using test_island::kDt_s;
constexpr double kHalf_m = 5e-3, kMass_kg = 0.02, kGravity_m_s2 = 9.81;
constexpr int kLong = 1000;

/// Cubes of 10 mm with four contacts on each face that touches another.
struct Cubes : test_island::SmallIsland {
  btRigidBody& add(const Vec3& center, const Vec3& force_N) {
    btRigidBody& body = SmallIsland::add(kMass_kg, center, Vec3::Zero());
    body.applyCentralForce(toBt(force_N));
    return body;
  }
  // Contacts of `upper` with the cube below it.
  void touch(btRigidBody& upper, btRigidBody& lower, double mu) {
    for (const double x : {-kHalf_m, kHalf_m})
      for (const double y : {-kHalf_m, kHalf_m})
        SmallIsland::touch(upper, lower, fromBt(upper.getWorldTransform()) * Vec3(x, y, -kHalf_m),
                           Vec3(0, 0, 1), 0, mu);
  }
  SolveOutcome solve(int limit) {
    ContactNewton newton(island, joints);
    const SolveOutcome outcome = newton.solve(sweeps.contacts(), 1e-9, limit);
    sweeps.applyImpulses();
    return outcome;
  }
};

/// A tower. Each contact carries a quarter of the weight above it.
struct Tower : Cubes {
  static constexpr int kCubes = 20;
  Tower() {
    btRigidBody* below = &floor;
    for (int k = 0; k < kCubes; ++k) {
      btRigidBody& cube = add(Vec3(0, 0, (2 * k + 1) * kHalf_m), Vec3(0, 0, -kMass_kg * kGravity_m_s2));
      touch(cube, *below, 0.3);
      below = &cube;
    }
    start();
  }
  /// Greatest error, as a share of the tower's weight.
  [[nodiscard]] double error() {
    double most = 0;
    for (std::size_t i = 0; i < sweeps.contacts().size(); ++i) {
      const double above = kCubes - static_cast<double>(i / 4);
      const double p_Ns = above / 4 * kMass_kg * kGravity_m_s2 * kDt_s;
      most = std::max(most, std::abs(sweeps.contacts()[i].p_n - p_Ns));
    }
    return most / (kCubes * kMass_kg * kGravity_m_s2 * kDt_s / 4);
  }
};

TEST(ContactNewton, CarriesTheWeightOfATowerWhereSweepsDoNot) {
  Tower swept, tower;
  swept.sweeps.sweep(1e-9, kLong);
  EXPECT_GT(swept.error(), 1e-3);
  const SolveOutcome outcome = tower.solve(kLong);
  EXPECT_TRUE(outcome.is_converged);
  EXPECT_LT(outcome.steps, 40);
  EXPECT_LT(tower.error(), 1e-6);
}

TEST(ContactNewton, SlidesWithTheForceBeyondFrictionAndSticksBelow) {
  constexpr double mu = 0.3;
  for (const double pull : {0.5, 0.2}) {  // sideways force, as a share of the weight
    Cubes cubes;
    const double weight_N = kMass_kg * kGravity_m_s2;
    for (int k = 0; k < 20; ++k) {
      btRigidBody& cube = cubes.add(Vec3(0.02 * k, 0, kHalf_m), Vec3(0, pull * weight_N, -weight_N));
      cubes.touch(cube, cubes.floor, mu);
    }
    cubes.start();
    EXPECT_TRUE(cubes.solve(kLong).is_converged);
    const double speed_m_s = std::max(0.0, pull - mu) * kGravity_m_s2 * kDt_s;
    for (const IslandBody& b : cubes.island.bodies)
      EXPECT_NEAR((b.u - stacked(Vec3(0, 0, 0), Vec3(0, speed_m_s, 0))).norm(), 0, 1e-6);
    for (const RigidContact& c : cubes.sweeps.contacts())
      EXPECT_LE(std::hypot(c.p_t[0], c.p_t[1]), (1 + 1e-9) * c.mu * c.p_n);
  }
}

// Contacts with normals in all directions, either order of bodies, gaps, a moving floor, and pairs whose
// contacts are not consecutive. ContactNewton must give the same velocities as ContactSweeps in many sweeps.
struct Random : Cubes {
  static constexpr int kCubes = 15;
  explicit Random(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto vector = [&] { return Vec3(in(engine), in(engine), in(engine)); };
    floor.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    floor.setLinearVelocity(btVector3(toBt(0.01), 0, toBt(0.02)));
    floor.setAngularVelocity(btVector3(0, toBt(0.1), 0));
    for (int k = 0; k < kCubes; ++k)
      add(0.03 * vector(), kMass_kg * (kGravity_m_s2 * Vec3(0, 0, -1) + 10 * vector()));
    for (int round = 0; round < 2; ++round)
      for (int k = 0; k < kCubes; ++k) {
        btRigidBody& other = k % 5 == 0 ? floor : bodies[static_cast<std::size_t>(k - 1)];
        btRigidBody* pair[2] = {&bodies[static_cast<std::size_t>(k)], &other};
        if (k % 2) std::swap(pair[0], pair[1]);
        for (int i = 0; i < 2; ++i) {
          const Vec3 n = (vector() + Vec3(0, 0, k % 2 ? -2 : 2)).normalized(), at = 0.03 * vector();
          SmallIsland::touch(*pair[0], *pair[1], at, n, 1e-6 * (1 + in(engine)), 0.2);
        }
      }
    start();
  }
};

TEST(ContactNewton, RandomContactsHaveTheVelocitiesOfManySweeps) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random swept(seed), random(seed);
    swept.sweeps.sweep(1e-12, 100'000);
    EXPECT_TRUE(random.solve(kLong).is_converged) << seed;
    for (std::size_t k = 0; k < Random::kCubes; ++k) {
      const Vec6 off = random.island.bodies[k].u - swept.island.bodies[k].u;
      EXPECT_LE(off.tail<3>().norm() + kHalf_m * off.head<3>().norm(), 1e-6) << seed << ' ' << k;
    }
  }
}

// Bodies with faces on each other all around, which hold each other by friction. If one contact slips, the
// load of all contacts changes.
struct Heap : Cubes {
  explicit Heap(unsigned seed) {
    constexpr int kCubes = 12, kFaces = 16;
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto vector = [&] { return Vec3(in(engine), in(engine), in(engine)); };
    for (int k = 0; k < kCubes; ++k) {
      btRigidBody& cube = add(0.02 * vector(), Vec3(0, 0, -kMass_kg * kGravity_m_s2));
      cube.setLinearVelocity(toBt(Vec3(-10 * fromBt(cube.getWorldTransform()).p + 0.05 * vector())));
    }
    for (int k = 0; k < kFaces; ++k) {
      const auto any = [&] {
        return std::min(static_cast<int>(0.5 * (1 + in(engine)) * (kCubes + 1)), kCubes);
      };
      const int i = any(), j = any();
      if (i == j) continue;
      btRigidBody* pair[2];
      for (int m : {0, 1})
        pair[m] = (m ? j : i) < kCubes ? &bodies[static_cast<std::size_t>(m ? j : i)] : &floor;
      const Vec3 from = fromBt(pair[1]->getWorldTransform()).p, to = fromBt(pair[0]->getWorldTransform()).p;
      const Vec3 n = ((to - from).normalized() + 0.3 * vector()).normalized(), u = n.unitOrthogonal(),
                 v = n.cross(u);
      for (const double a : {-kHalf_m, kHalf_m})
        for (const double b : {-kHalf_m, kHalf_m})
          SmallIsland::touch(*pair[0], *pair[1], 0.5 * (from + to) + a * u + b * v, n, 0, 0.3);
    }
    start();
  }
};

// If the slip terms were taken from the previous round (outer iteration), half of the problems would not be
// solved in this number of steps.
TEST(ContactNewton, SettlesTheFrictionOfAHeapInFewSteps) {
  constexpr int kHeaps = 50, kMost = 60;
  int converged = 0, steps = 0;
  for (unsigned seed = 1; seed <= kHeaps; ++seed) {
    Heap heap(seed);
    heap.sweeps.sweep(1e-6, 30);
    ContactNewton newton(heap.island, heap.joints);
    const SolveOutcome outcome = newton.solve(heap.sweeps.contacts(), 1e-6, kMost);
    converged += outcome.is_converged;
    steps += outcome.steps;
  }
  EXPECT_GE(converged, kHeaps - 1);
  EXPECT_LE(steps, 30 * kHeaps);
  std::printf("[ measured ] %d of %d, %.1f steps\n", converged, kHeaps, 1.0 * steps / kHeaps);
}

TEST(ContactNewton, LeavesTheImpulsesWhereAVelocityIsNotFinite) {
  Tower tower;
  tower.solve(kLong);
  tower.island.bodies.back().momentum[5] = std::nan("");
  ContactNewton newton(tower.island, tower.joints);
  EXPECT_FALSE(newton.solve(tower.sweeps.contacts(), 1e300, kLong).is_converged);
  EXPECT_LT(tower.error(), 1e-5);
}

TEST(ContactNewton, AContactOnlyPushes) {
  Cubes cubes;
  for (int k = 0; k < 20; ++k) {
    btRigidBody& cube =
        cubes.add(Vec3(0.02 * k, 0, kHalf_m), Vec3(0, 0, (k % 2 ? 1 : -1) * kMass_kg * kGravity_m_s2));
    cubes.touch(cube, cubes.floor, 0.3);
  }
  cubes.start();
  EXPECT_TRUE(cubes.solve(kLong).is_converged);
  for (std::size_t k = 0; k < 20; ++k)
    EXPECT_NEAR(cubes.island.bodies[k].u[5], k % 2 ? kGravity_m_s2 * kDt_s : 0, 1e-6) << k;
}

}  // namespace
}  // namespace vps::bullet
