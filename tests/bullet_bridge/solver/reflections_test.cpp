// SPDX-License-Identifier: BSD-3-Clause
// Projections and reflections of velocities, against the conditions of optimality, conservation and known
// impacts.
#include "solver/impact/reflections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vps::bullet {
namespace {

struct Bodies {
  std::vector<Mat6> inverse_mass;
  std::vector<Vec6> v;
  std::vector<Vec3> place;
  std::vector<ImpactRow> rows;

  void add(double mass_kg, const Vec3& at, const Vec3& v_m_s, const Vec3& w_rad_s = Vec3::Zero()) {
    Mat6 inverse = Mat6::Identity() / mass_kg;
    inverse.topLeftCorner<3, 3>() /= 7e-5;  // of a cube of 20 mm
    inverse_mass.push_back(inverse);
    v.push_back(stacked(w_rad_s, v_m_s));
    place.push_back(at);
  }
  // n from b to a; b = -1: a wall
  void touch(int a, int b, const Vec3& x, const Vec3& n, double restitution) {
    ImpactRow row;
    const int body[2] = {a, b};
    for (int i = 0; i < 2; ++i) {
      row.body[i] = body[i];
      if (body[i] < 0) continue;
      const Vec3 d = i == 0 ? n : Vec3(-n);
      row.J[i] = stacked((x - place[static_cast<std::size_t>(body[i])]).cross(d), d);
    }
    row.restitution = restitution;
    row.prepare(inverse_mass);
    rows.push_back(row);
  }
  [[nodiscard]] double energy_J(const std::vector<Vec6>& of) const {
    double sum = 0;
    for (std::size_t i = 0; i < of.size(); ++i) sum += 0.5 * of[i].dot(inverse_mass[i].inverse() * of[i]);
    return sum;
  }
  [[nodiscard]] Vec3 momentum(const std::vector<Vec6>& of) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < of.size(); ++i) sum += of[i].tail<3>() / inverse_mass[i](3, 3);
    return sum;
  }
};

/// Cubes of 20 mm in a row along x, with 12 contacts on each face.
Bodies row(int count, double e, double first_m_s, const std::vector<double>& mass_kg) {
  Bodies b;
  for (int i = 0; i < count; ++i)
    b.add(mass_kg[static_cast<std::size_t>(i)], Vec3(0.02 * i, 0, 0), Vec3(i == 0 ? first_m_s : 0, 0, 0));
  for (int i = 0; i + 1 < count; ++i)
    for (int k = 0; k < 12; ++k)
      b.touch(i + 1, i, Vec3(0.02 * i + 0.01, 0.01 * std::cos(0.5 * k), 0.01 * std::sin(0.5 * k)),
              Vec3(1, 0, 0), e);
  return b;
}

Bodies random(unsigned seed, bool one_e) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> in(-1, 1);
  const auto vector = [&] { return Vec3(in(engine), in(engine), in(engine)); };
  const double e = 0.5 + 0.5 * in(engine);
  Bodies b;
  for (int i = 0; i < 5; ++i) b.add(std::exp(2 * in(engine)), Vec3(0.02 * i, 0, 0), vector(), 30 * vector());
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 6; ++k)
      b.touch(i, i - 1, Vec3(0.02 * i - 0.01, 0, 0) + 0.01 * vector(),
              (Vec3(1, 0, 0) + 0.4 * vector()).normalized(), one_e ? e : std::abs(in(engine)));
  return b;
}

TEST(ImpactProjection, IsTheNearestVelocityWithoutApproach) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Bodies b = random(seed, true);
    std::vector<Vec6> v = b.v;
    std::vector<double> p;
    ImpactProjection(b.rows).solve(std::vector<std::uint8_t>(b.rows.size(), 1), 1e-10, v, p);
    for (std::size_t i = 0; i < b.rows.size(); ++i) {
      EXPECT_GE(p[i], 0);
      EXPECT_GE(b.rows[i].velocity(v), -1e-9) << seed;
      EXPECT_LE(p[i] * b.rows[i].velocity(v), 1e-9) << seed;  // no impulse where bodies separate
    }
  }
}

TEST(ImpactProjection, OfFlushFacesDoesNotTurnThem) {
  const Bodies b = row(5, 0, 1, {1, 1, 1, 1, 1});
  std::vector<Vec6> v = b.v;
  std::vector<double> p;
  ImpactProjection(b.rows).solve(std::vector<std::uint8_t>(b.rows.size(), 1), 1e-10, v, p);
  for (const Vec6& one : v) EXPECT_LE((one - stacked(Vec3(0, 0, 0), Vec3(0.2, 0, 0))).norm(), 1e-12);
}

TEST(Reflections, AnImpactPassesAlongARow) {
  for (const int count : {2, 3, 5, 8}) {
    const Bodies b = row(count, 1, 1, std::vector<double>(static_cast<std::size_t>(count), 0.03));
    const ImpactState after = afterImpact(b.rows, b.v);
    for (int i = 0; i < count; ++i)
      EXPECT_LE(
          (after.v[static_cast<std::size_t>(i)] - stacked(Vec3(0, 0, 0), Vec3(i == count - 1, 0, 0))).norm(),
          1e-10)
          << count;
  }
}

TEST(Reflections, RestitutionBlendsElasticAndInelastic) {
  const Bodies b = row(3, 0.5, 1, {1, 1, 1});
  const ImpactState after = afterImpact(b.rows, b.v);
  const double expected[3] = {1.0 / 6, 1.0 / 6, 2.0 / 3};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(after.v[static_cast<std::size_t>(i)][3], expected[i], 1e-12);
}

TEST(Reflections, EachWallOfACornerHasItsOwnRestitution) {
  Bodies b;
  b.add(1, Vec3::Zero(), Vec3(-1, -2, -3));
  const double e[3] = {1, 0.4, 0};
  for (int i = 0; i < 3; ++i) b.touch(0, -1, Vec3::Zero(), Vec3::Unit(i), e[i]);
  const ImpactState after = afterImpact(b.rows, b.v);
  EXPECT_LE((after.v[0].tail<3>() - Vec3(1, 0.8, 0)).norm(), 1e-12);
}

TEST(Reflections, ALightBodyBetweenHeavyOnesPassesAllEnergyOn) {
  const Bodies b = row(3, 1, 1, {1, 1e-4, 1e4});
  const ImpactState after = afterImpact(b.rows, b.v);
  EXPECT_NEAR(b.energy_J(after.v), b.energy_J(b.v), 1e-4 * b.energy_J(b.v));
  EXPECT_LT(after.v[0][3], -0.99);
}

// There are thousands of impacts, or more than the work budget allows; the light body then acts as a massless
// spacer.
TEST(Reflections, AnyLightBodyBetweenOthersPassesAllEnergyOn) {
  for (const double ratio : {1e-3, 1e-5, 1e-6, 1e-7, 1e-9}) {
    const Bodies b = row(3, 1, 1, {1, ratio, 1});
    const ImpactState after = afterImpact(b.rows, b.v);
    EXPECT_NEAR(b.energy_J(after.v), b.energy_J(b.v), 1e-4 * b.energy_J(b.v)) << ratio;
    EXPECT_NEAR(b.momentum(after.v).x(), b.momentum(b.v).x(), 1e-12) << ratio;
    EXPECT_GT(after.v[2][3], 0.9) << ratio;
    for (const ImpactRow& r : b.rows) EXPECT_GE(r.velocity(after.v), -1e-7) << ratio;
  }
}

// The same rows are chosen repeatedly. The last active set is used only if it is the solution.
TEST(ImpactProjection, IsTheSameWithAndWithoutEarlierSolutions) {
  const Bodies rows = random(1, true);
  ImpactProjection with_earlier(rows.rows);
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const Bodies b = random(seed, true);
    std::vector<std::uint8_t> chosen(rows.rows.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = i % (1 + seed % 3) == 0;
    std::vector<Vec6> v = b.v, alone = b.v;
    std::vector<double> p, p_alone;
    with_earlier.solve(chosen, 1e-10, v, p);
    ImpactProjection(rows.rows).solve(chosen, 1e-10, alone, p_alone);
    for (std::size_t i = 0; i < v.size(); ++i) EXPECT_LE((v[i] - alone[i]).norm(), 1e-7) << seed;
  }
}

TEST(Reflections, NeverMakeEnergyNorApproachAndKeepMomentum) {
  for (unsigned seed = 1; seed <= 200; ++seed)
    for (const bool one_e : {true, false}) {
      const Bodies b = random(seed, one_e);
      const ImpactState after = afterImpact(b.rows, b.v);
      EXPECT_LE(b.energy_J(after.v), (1 + 1e-12) * b.energy_J(b.v)) << seed;
      for (const ImpactRow& r : b.rows) EXPECT_GE(r.velocity(after.v), -1e-7) << seed;
      Vec3 from_wall = Vec3::Zero();
      for (std::size_t i = 0; i < b.rows.size(); ++i)
        if (b.rows[i].body[1] < 0) from_wall += after.p_Ns[i] * b.rows[i].J[0].tail<3>();
      EXPECT_LE((b.momentum(after.v) - b.momentum(b.v) - from_wall).norm(), 1e-10) << seed;
    }
}

// A body on a table does not bounce off the table when it is hit from the side.
TEST(Reflections, AnInelasticContactReactsToAnElasticOne) {
  Bodies b;
  b.add(1, Vec3::Zero(), Vec3(-1, 0, 0));
  b.touch(0, -1, Vec3::Zero(), Vec3(0, 0, 1), 0);
  b.touch(0, -1, Vec3::Zero(), Vec3(0.8, 0, -0.6), 1);
  const ImpactState after = afterImpact(b.rows, b.v);
  EXPECT_LE((after.v[0].tail<3>() - Vec3(1, 0, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace vps::bullet
