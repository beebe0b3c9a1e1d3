// SPDX-License-Identifier: BSD-3-Clause
// Penalty points of a few bodies: the velocities at which inertia, springs and bristles balance.
#include "solver/penalty/penalty_newton.h"

#include <gtest/gtest.h>

#include "bullet_bridge/small_island.h"

namespace vps::bullet {
namespace {

using namespace test_island;

constexpr double kPenaltyNear_m_s = 1e-10;
constexpr int kManyNewtonSteps = 200;

PenaltyPoint pointAt(const Vec3& p_W, const Vec3& n_W, double gap_m, double k_N_per_m) {
  PenaltyPoint point;
  point.p_W = p_W;
  point.n_W = n_W;
  point.gap_m = gap_m;
  point.k_N_per_m = k_N_per_m;
  return point;
}

// Limits of friction depend on the forces: solves until they do not change.
void solve(SmallIsland& made, std::vector<PenaltyPair>& pairs) {
  PenaltyNewton newton(made.island, made.joints);
  newton.clear(kDt_s);
  for (PenaltyPair& pair : pairs) newton.add(pair, 0, false);
  for (int round = 0; round < 100; ++round) {
    ASSERT_TRUE(newton.solve(kPenaltyNear_m_s, kManyNewtonSteps, PenaltyNewton::End::Balanced).is_converged);
    if (newton.updateLimits() < 1e-12) break;
  }
  newton.finish();
}

// m (u - u0) = dt k (-(gap + dt u)), an implicit Euler step of a mass on a spring.
TEST(PenaltyNewton, ABlockOnFourSpringsTakesAnImplicitEulerStep) {
  constexpr double kMass_kg = 0.02;
  for (const double k_N_per_m : {1e2, 1e5, 1e9})
    for (const double v_m_s : {-1.0, 0.0, 0.5}) {
      SmallIsland made;
      made.add(kMass_kg, Vec3(0, 0, 5e-3), Vec3(0, 0, v_m_s));
      made.start();
      std::vector<PenaltyPair> pairs(1);
      pairs[0].object[0] = &made.bodies[0];
      pairs[0].object[1] = &made.floor;
      constexpr double kGap_m = -5e-6;
      for (const double x : {-5e-3, 5e-3})
        for (const double y : {-5e-3, 5e-3})
          pairs[0].points.push_back(pointAt(Vec3(x, y, 0), Vec3(0, 0, 1), kGap_m, 0.25 * k_N_per_m));
      solve(made, pairs);
      const double pressed_m_s =
          (kMass_kg * v_m_s - kDt_s * k_N_per_m * kGap_m) / (kMass_kg + kDt_s * kDt_s * k_N_per_m);
      const double wanted_m_s =
          kGap_m + kDt_s * pressed_m_s < 0 ? pressed_m_s : v_m_s;  // otherwise the mass lifts off
      EXPECT_NEAR(made.solved()[0][5], wanted_m_s, 1e-9) << k_N_per_m << ' ' << v_m_s;
      EXPECT_LE(made.solved()[0].head<5>().norm(), 1e-9);
    }
}

struct RandomPoints {
  SmallIsland made;
  std::vector<PenaltyPair> pairs{3};
  explicit RandomPoints(std::uint64_t seed, double mu) {
    test::Random random(seed);
    for (int k = 0; k < 3; ++k)
      made.add(random.logUniform(0.005, 0.5), random.inBox(Vec3::Constant(0.02)),
               random.inBox(Vec3::Constant(1)), random.inBox(Vec3::Constant(50)), random.rotation());
    made.start();
    for (std::size_t k = 0; k < 3; ++k) {
      pairs[k].object[0] = &made.bodies[k];
      pairs[k].object[1] = k == 0 ? &made.floor : &made.bodies[k - 1];
      for (int i = 0; i < 6; ++i) {
        pairs[k].points.push_back(pointAt(random.inBox(Vec3::Constant(0.02)), random.direction(),
                                          random.uniform(-50e-6, 50e-6), random.logUniform(1e3, 1e7)));
        pairs[k].points.back().mu = mu;
      }
    }
  }
  [[nodiscard]] GivenContact contactOf(const PenaltyPair& pair, const PenaltyPoint& p) const {
    return {
        {static_cast<const btRigidBody*>(pair.object[0]), static_cast<const btRigidBody*>(pair.object[1])},
        p.p_W,
        p.n_W,
        p.gap_m,
        p.mu};
  }
};

TEST(PenaltyNewton, EachPointPushesByItsGapAtTheEndOfTheStepAndHoldsWithinCoulombsCone) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    RandomPoints random(seed, 0.3);
    solve(random.made, random.pairs);
    const std::vector<Vec6> u = random.made.solved();
    for (const PenaltyPair& pair : random.pairs)
      for (const PenaltyPoint& p : pair.points) {
        const Vec3 v = random.made.velocityAt(random.contactOf(pair, p), u);
        const double wanted_N = p.k_N_per_m * std::max(0.0, -(p.gap_m + kDt_s * v.dot(p.n_W)));
        EXPECT_NEAR(p.f_n_N, wanted_N, 1e-6 * (1 + wanted_N)) << seed;
        const double held_N = p.k_N_per_m * p.bend_W.norm();
        EXPECT_LE(held_N, p.mu * p.f_n_N * (1 + 1e-6) + 1e-9) << seed;
        // Inside the friction cone the bristle is deflected by the whole displacement.
        if (held_N < 0.99 * p.mu * p.f_n_N) {
          EXPECT_LE((p.bend_W - kDt_s * (v - v.dot(p.n_W) * p.n_W)).norm(), 1e-12) << seed;
        }
      }
  }
}

TEST(PenaltyNewton, TheForcesChangeTheMomentumOfEachBody) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    RandomPoints random(seed, 0.3);
    solve(random.made, random.pairs);
    for (std::size_t b = 0; b < random.made.free.size(); ++b) {
      const IslandBody& body = random.made.island.bodies[b];
      Vec6 owed = body.mass * (body.u - random.made.free[b]);
      for (const PenaltyPair& pair : random.pairs)
        for (int i = 0; i < 2; ++i) {
          if (pair.object[i] != body.rigid) continue;
          for (const PenaltyPoint& p : pair.points) {
            const Vec3 f = (i == 0 ? 1 : -1) * kDt_s * (p.f_n_N * p.n_W - p.k_N_per_m * p.bend_W);
            const Vec3 r = p.p_W - fromBt(body.rigid->getWorldTransform().getOrigin());
            owed -= stacked(r.cross(f), f);
          }
        }
      EXPECT_LE((body.mass.inverse() * owed).tail<3>().norm(), 1e-6) << seed;
    }
  }
}

// Kinetic energy and that of the springs at the end of the step are not more than both at its start.
TEST(PenaltyNewton, NeverAddsEnergy) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    for (const double mu : {0.0, 0.3}) {
      RandomPoints random(seed, mu);
      double before_J = random.made.energy_J(random.made.free);
      for (const PenaltyPair& pair : random.pairs)
        for (const PenaltyPoint& p : pair.points)
          before_J += 0.5 * p.k_N_per_m * std::pow(std::min(0.0, p.gap_m), 2);
      solve(random.made, random.pairs);
      const std::vector<Vec6> u = random.made.solved();
      double after_J = random.made.energy_J(u);
      for (const PenaltyPair& pair : random.pairs)
        for (const PenaltyPoint& p : pair.points) after_J += 0.5 * p.f_n_N * p.f_n_N / p.k_N_per_m;
      EXPECT_LE(after_J, before_J * (1 + 1e-9)) << seed << ' ' << mu;
    }
}

}  // namespace
}  // namespace vps::bullet
