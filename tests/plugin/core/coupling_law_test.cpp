// SPDX-License-Identifier: BSD-3-Clause
#include "vps/coupling_law.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "support/no_alloc.h"
#include "support/random_draw.h"

namespace vps {
namespace {

constexpr double kEps = 1e-12;  // a few roundings of numbers of order ten

CouplingState at(const Vec3& p_W, const Vec3& rotation = Vec3::Zero()) {
  CouplingState state;
  state.X_W = Pose(rotationFromVector(rotation), p_W);
  state.is_coupled = true;
  return state;
}

TEST(CouplingLaw, EqualPosesAtRestGiveNoWrench) {
  const CouplingState state = at({1, 2, 3}, {0.4, -0.2, 0.9});
  const Wrench F = couplingWrench({}, state, state);
  EXPECT_LT(F.f.norm(), kEps);
  EXPECT_LT(F.tau.norm(), kEps);
}

TEST(CouplingLaw, PullsThePartTowardsTheProxyByHookesLaw) {
  CouplingGains gains;
  gains.k_N_per_m = 1000;
  gains.k_Nm_per_rad = 3;
  const Vec3 p_W(1e-3, -2e-3, 3e-3), r(0.1, 0.2, -0.3);
  const Wrench F = couplingWrench(gains, at(p_W, r), at(Vec3::Zero()));
  EXPECT_LT((F.f - 1000 * p_W).norm(), kEps);
  EXPECT_LT((F.tau - 3 * r).norm(), kEps);
}

// The energy is the work of the spring's force from zero to the stretch: k x^2 / 2 up to the limit, then the
// constant force times the remaining stretch.
TEST(CouplingLaw, EnergyIsTheWorkOfTheLimitedSprings) {
  CouplingGains gains;
  gains.k_N_per_m = 1000;
  gains.max_force_N = 10;
  gains.k_Nm_per_rad = 2;
  gains.max_torque_Nm = 1;
  const CouplingState part = at(Vec3::Zero());
  EXPECT_EQ(couplingEnergy_J(gains, part, part), 0);
  EXPECT_NEAR(couplingEnergy_J(gains, at({0.004, 0, 0.003}), part), 0.5 * 1000 * 0.005 * 0.005, kEps);
  EXPECT_NEAR(couplingEnergy_J(gains, at({0.03, 0, 0}), part), 0.05 + 10 * 0.02, kEps);
  EXPECT_NEAR(couplingEnergy_J(gains, at(Vec3::Zero(), {0, 0.1, 0}), part), 0.01, kEps);
  EXPECT_NEAR(couplingEnergy_J(gains, at(Vec3::Zero(), {0, 0.7, 0}), part), 0.25 + 0.2, kEps);
}

TEST(CouplingLaw, DampsTheDifferenceOfVelocities) {
  CouplingGains gains;
  gains.b_Ns_per_m = 5;
  gains.b_Nms_per_rad = 0.5;
  CouplingState proxy = at(Vec3::Zero()), part = proxy;
  proxy.V_W = {Vec3(0, 0, 2), Vec3(1, 0, 0)};
  part.V_W = {Vec3(0, 0, 1), Vec3(0, 1, 0)};
  const Wrench F = couplingWrench(gains, proxy, part);
  EXPECT_LT((F.f - Vec3(5, -5, 0)).norm(), kEps);
  EXPECT_LT((F.tau - Vec3(0, 0, 0.5)).norm(), kEps);
}

TEST(CouplingLaw, TheSpringIsLimitedInItsOwnDirectionAndDampingIsAddedAfter) {
  CouplingGains gains;
  gains.max_force_N = 10;
  gains.max_torque_Nm = 1;
  CouplingState proxy = at({3, 4, 0}, {0, 0, 2.0});
  proxy.V_W.v = Vec3(0, 0, 1);
  const Wrench F = couplingWrench(gains, proxy, at(Vec3::Zero()));
  EXPECT_LT((F.f - Vec3(6, 8, gains.b_Ns_per_m)).norm(), kEps);
  EXPECT_LT((F.tau - Vec3(0, 0, 1)).norm(), kEps);
}

TEST(CouplingLaw, HalfATurnIsTheLargestRotationAndStaysFinite) {
  CouplingGains gains;
  gains.k_Nm_per_rad = 1;
  gains.max_torque_Nm = 100;
  const Wrench F = couplingWrench(gains, at(Vec3::Zero(), {std::numbers::pi, 0, 0}), at(Vec3::Zero()));
  EXPECT_NEAR(F.tau.norm(), std::numbers::pi, 1e-7);  // the angle near pi comes from a sine: half the digits
}

TEST(CouplingLaw, MovingBothFramesByOneRotationOnlyRotatesTheWrench) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return test::drawnVector(unit, random); };
  for (int i = 0; i < 100; ++i) {
    const Vec3 p_proxy = 0.01 * vec(), p_part = 0.01 * vec();
    CouplingState proxy = at(p_proxy, vec()), part = at(p_part, vec());
    proxy.V_W = {vec(), vec()};
    part.V_W = {vec(), vec()};
    const Pose X_AW{rotationFromVector(3 * vec()), vec()};
    const auto moved = [&](CouplingState state) {
      state.X_W = X_AW * state.X_W;
      state.V_W = {X_AW.R * state.V_W.w, X_AW.R * state.V_W.v};
      return state;
    };
    const Wrench F_W = couplingWrench({}, proxy, part);
    const Wrench F_A = couplingWrench({}, moved(proxy), moved(part));
    const Wrench expected = rotated(X_AW.R, F_W);
    EXPECT_LT((F_A.f - expected.f).norm(), 1e-10);
    EXPECT_LT((F_A.tau - expected.tau).norm(), 1e-10);
  }
}

TEST(CouplingLaw, AnythingNotFiniteGivesZeroWithoutAllocating) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    CouplingState bad_position = at({0.001, 0, 0}), bad_rotation = bad_position, bad_velocity = bad_position;
    bad_position.X_W.p.y() = bad;
    bad_rotation.X_W.R(1, 2) = bad;
    bad_velocity.V_W.w.x() = bad;
    CouplingGains bad_gains;
    bad_gains.b_Ns_per_m = bad;
    const CouplingState good = at(Vec3::Zero());
    const vps_test::NoAllocScope guard;
    for (const CouplingState& state : {bad_position, bad_rotation, bad_velocity}) {
      for (const Wrench& F : {couplingWrench({}, state, good), couplingWrench({}, good, state)}) {
        EXPECT_TRUE(F.f.isZero(0));
        EXPECT_TRUE(F.tau.isZero(0));
      }
    }
    CouplingState moving = good;
    moving.V_W.v.x() = 1;
    EXPECT_TRUE(couplingWrench(bad_gains, moving, good).f.isZero(0));
  }
}

}  // namespace
}  // namespace vps
