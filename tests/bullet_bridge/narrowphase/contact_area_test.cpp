// SPDX-License-Identifier: BSD-3-Clause
// The contacts of a flush face represent its area and share its load evenly.
#include "narrowphase/selection/contact_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bullet_bridge/small_island.h"
#include "solver/contact_key.h"
#include "solver/rigid/even_pressure.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

constexpr double kSize_m = 10e-3, kMargin_m = 20e-6;

// Points of a face, anywhere in space, each with its share of the area: a disc, a ring or a rectangle.
std::vector<Candidate> faceOf(int kind, std::uint64_t seed, const Pose& X_WF) {
  test::Random random(seed);
  constexpr std::uint32_t kPoints = 1000;
  std::vector<Candidate> points;
  while (points.size() < kPoints) {
    Vec3 p = random.inBox(Vec3(kSize_m, kind == 2 ? 0.3 * kSize_m : kSize_m, 0));
    if (kind < 2 && !(p.norm() < kSize_m && p.norm() >= kind * 0.6 * kSize_m)) continue;
    Candidate& c = points.emplace_back();
    c.id = static_cast<std::uint32_t>(points.size());
    c.p_W = X_WF * p;
    c.n_W = X_WF.R.col(2);
    c.area_m2 = 1e-7;
  }
  return points;
}

struct Sums {
  double area_m2 = 0, radius = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};
Sums sumsOf(const std::vector<Candidate>& points, const Pose& X_WF) {
  Sums s;
  for (const Candidate& c : points) {
    const Vec3 r = X_WF.inverse() * c.p_W;
    s.area_m2 += c.area_m2;
    s.radius += c.area_m2 * r.norm();
    s.first += c.area_m2 * r;
    s.second += c.area_m2 * r * r.transpose();
  }
  return s;
}

TEST(ContactArea, ThirtyTwoContactsHaveTheMomentsOfTheWholeFace) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    test::Random random(seed);
    const Pose X_WF(random.rotation(), random.inBox(Vec3::Constant(0.1)));
    const std::vector<Candidate> all = faceOf(static_cast<int>(seed % 3), seed, X_WF);
    std::vector<Candidate> chosen = all;
    reduceBySpread(chosen, 32, kSize_m, kMargin_m);
    shareAreas(all, kSize_m, chosen);
    ASSERT_EQ(chosen.size(), 32u);
    const Sums want = sumsOf(all, X_WF), got = sumsOf(chosen, X_WF);
    // The least change of the areas is found to an accuracy of kSettledShare. An area that would become
    // negative is set to a small positive value.
    EXPECT_NEAR(got.area_m2 / want.area_m2, 1, 0.005) << seed;
    EXPECT_LE((got.first - want.first).norm(), 0.005 * want.area_m2 * kSize_m) << seed;
    EXPECT_LE((got.second - want.second).norm(), 0.005 * want.second.norm()) << seed;
    // The friction torque against a spin depends on the mean distance from the axis.
    EXPECT_NEAR(got.radius / want.radius, 1, 0.03) << seed;
  }
}

TEST(ContactArea, MergedPointsKeepTheirMoments) {
  const std::vector<Candidate> all = faceOf(0, 1, Pose());
  Candidate sum = all.front();
  for (std::size_t i = 1; i < all.size(); ++i) addArea(all[i], sum);
  const Sums want = sumsOf(all, Pose());
  EXPECT_NEAR(sum.area_m2, want.area_m2, 1e-9 * want.area_m2);
  EXPECT_LE((sum.areaCenter_W() * sum.area_m2 - want.first).norm(), 1e-9 * want.area_m2 * kSize_m);
  const Mat3 second =
      sum.area_m2 * (sum.area_spread.cast<double>() + sum.areaCenter_W() * sum.areaCenter_W().transpose());
  EXPECT_LE((second - want.second).norm(), 1e-5 * want.second.norm());  // area_spread is stored in floats
}

// Two faces with opposite normals: the area of a dropped point goes to a contact of the same face.
TEST(ContactArea, ReductionByCellsKeepsTheMomentsOfEachFace) {
  std::vector<Candidate> points = faceOf(0, 1, Pose());
  const std::vector<Candidate> up = points;
  const Pose down(rotationFromVector({std::numbers::pi, 0, 0}), Vec3(0, 0, 1e-3));
  for (Candidate c : faceOf(2, 2, down)) {
    c.id += 1000;
    points.push_back(c);
  }
  const std::vector<Candidate> all = points;
  reduceByCell(points, 60, kSize_m / 16, kSize_m);
  ASSERT_LT(points.size(), 300u);
  for (const double side : {1.0, -1.0}) {
    const auto momentsOf = [&](const std::vector<Candidate>& of) {
      Candidate sum;
      for (const Candidate& c : of)
        if (c.n_W.z() * side > 0) addArea(c, sum);
      return sum;
    };
    const Candidate want = momentsOf(all), got = momentsOf(points);
    EXPECT_NEAR(got.area_m2, want.area_m2, 1e-9 * want.area_m2);
    EXPECT_LE((got.areaCenter_W() - want.areaCenter_W()).norm(), 1e-9);
    EXPECT_LE((got.area_spread - want.area_spread).norm(), 1e-4F * want.area_spread.norm());
  }
}

/// A cube of 10 mm on a floor with n x n contacts of areas that the test sets.
struct Block : test_island::SmallIsland {
  explicit Block(int n, double mu = 0.3) {
    btRigidBody& cube = add(0.02, Vec3(0, 0, 5e-3), Vec3::Zero());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        touch(cube, floor, Vec3((i / (n - 1.0) - 0.5) * 10e-3, (j / (n - 1.0) - 0.5) * 10e-3, 0),
              Vec3(0, 0, 1), 0, mu);
    start();
    for (RigidContact& c : sweeps.contacts()) c.area_m2 = 1e-6;
  }
  std::vector<RigidContact>& contacts() { return sweeps.contacts(); }
  void spread() { EvenPressure(island).spread(contacts()); }
  [[nodiscard]] Vec6 wrench() {
    Vec6 sum = Vec6::Zero();
    for (const RigidContact& c : contacts()) {
      const Vec3 p = c.p_n * c.normal_W() + c.p_t[0] * c.tangent_W(0) + c.p_t[1] * c.tangent_W(1);
      sum += stacked(c.position_W().cross(p), p);
    }
    return sum;
  }
};

TEST(EvenPressure, SpreadsTheLoadOfFourCornersByTheAreas) {
  Block block(5);
  test::Random random(1);
  double whole_m2 = 0;
  for (std::size_t i = 0; i < 13; ++i)  // equal load on opposite sides
    block.contacts()[i].area_m2 = block.contacts()[24 - i].area_m2 = random.uniform(0.5e-6, 2e-6);
  for (const RigidContact& c : block.contacts()) whole_m2 += c.area_m2;
  for (const std::size_t corner : {0U, 4U, 20U, 24U}) block.contacts()[corner].p_n = 1e-3;
  const Vec6 before = block.wrench();
  block.spread();
  EXPECT_LE((block.wrench() - before).norm(), 1e-8);
  for (const RigidContact& c : block.contacts()) EXPECT_NEAR(c.p_n, 4e-3 * c.area_m2 / whole_m2, 1e-7);
}

TEST(EvenPressure, KeepsForceAndMomentOfAnyLoadAndNothingPulls) {
  int spread = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    test::Random random(seed);
    Block block(4);
    for (RigidContact& c : block.contacts()) {
      c.area_m2 = random.uniform(0.2e-6, 2e-6);
      c.p_n = random.chance(0.4) ? random.uniform(0, 1e-3) : 0;
      for (double& p_t : c.p_t) p_t = 0.2 * c.mu * c.p_n;
    }
    const Vec6 before = block.wrench();
    const std::vector<RigidContact> had = block.contacts();
    block.spread();
    // The solver may leave an error of a ten-thousandth of the load.
    EXPECT_LE((block.wrench() - before).norm(), 2e-4 * before.norm()) << seed;
    bool is_changed = false;
    for (std::size_t i = 0; i < had.size(); ++i) {
      const RigidContact& c = block.contacts()[i];
      EXPECT_GE(c.p_n, 0) << seed;
      EXPECT_LE(std::hypot(c.p_t[0], c.p_t[1]), c.mu * c.p_n * (1 + 1e-9) + 1e-18) << seed;
      is_changed = is_changed || c.p_n != had[i].p_n;
    }
    spread += is_changed;
  }
  EXPECT_GE(spread, 90);
}

TEST(EvenPressure, LeavesWhatIsEvenAndWhatIsHeldInOneWay) {
  Block block(4);
  for (RigidContact& c : block.contacts()) c.p_n = 1e-3;
  block.contacts()[5].p_n = 1.001e-3;
  block.spread();
  EXPECT_EQ(block.contacts()[5].p_n, 1.001e-3);

  Block tipped(4);  // on one corner
  tipped.contacts()[3].p_n = 1e-3;
  tipped.spread();
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(tipped.contacts()[i].p_n, i == 3 ? 1e-3 : 0, 1e-7) << i;
}

TEST(EvenPressure, FrictionOfWhatSlidesIsAlongTheSlipAndAtItsLimit) {
  Block block(4);
  block.island.bodies[0].u = stacked(Vec3(0, 0, 20), Vec3(0.01, 0, 0));
  for (const std::size_t corner : {0U, 3U, 12U, 15U}) {
    RigidContact& c = block.contacts()[corner];
    c.p_n = 1e-3;
    c.p_t[0] = c.mu * c.p_n;
  }
  block.spread();
  for (const RigidContact& c : block.contacts()) {
    const Vec3 slip = Vec3(0.01, 0, 0) + Vec3(0, 0, 20).cross(c.position_W());
    const Vec3 friction = c.p_t[0] * c.tangent_W(0) + c.p_t[1] * c.tangent_W(1);
    EXPECT_LE((friction + c.mu * c.p_n * slip.normalized()).norm(), 1e-9 + 1e-6 * c.mu * c.p_n);
  }
}

TEST(ContactKey, APointKeepsItsAreaUnlessTheUserGaveItASoftness) {
  btManifoldPoint point;
  EXPECT_EQ(area_m2(point), 0);
  setArea(point, 2e-6);
  EXPECT_EQ(area_m2(point), btScalar(2e-6));
  btManifoldPoint soft;
  soft.m_contactPointFlags = BT_CONTACT_FLAG_HAS_CONTACT_ERP;
  soft.m_contactERP = btScalar(0.3);
  setArea(soft, 2e-6);
  EXPECT_EQ(soft.m_contactERP, btScalar(0.3));
  EXPECT_EQ(area_m2(soft), 0);
}

}  // namespace
}  // namespace vps::bullet
