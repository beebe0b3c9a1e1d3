// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies against formulas for bar, plate and ring, and against thin-shell theory for tube and
// bell. The tolerance of 3 % is below the difference of two notes (a semitone is 6 %).
#include "modes/modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shell_theory.h"
#include "support/lathe.h"

namespace vps::viewer {
namespace {

constexpr Elasticity kSteel;
constexpr double kDensity_kg_m3 = 7850, kPi = std::numbers::pi;
constexpr double kBar = 0.03;

BodyModes modesOf(const Vec3& size_m, ModeSettings settings = {}) {
  return findModes(
      makeBox(size_m), [](const Vec3&) { return true; }, kDensity_kg_m3, kSteel, settings);
}
/// Relative difference between a frequency and that of the nearest mode.
double missed(const BodyModes& body, double hz) {
  double best = 1e9;
  for (const double f : body.frequency_hz) best = std::min(best, std::abs(f / hz - 1));
  return best;
}

/// Free-free bending of a slender bar: cos(x) cosh(x) = 1; Rao, "Mechanical Vibrations", 2011, section 8.5.
double bendingHz(double x, double length_m, double height_m) {
  const double radius_m = height_m / std::sqrt(12);
  return x * x / (2 * kPi * length_m * length_m) * radius_m *
         std::sqrt(kSteel.youngs_modulus_Pa / kDensity_kg_m3);
}

TEST(Modes, OfASlenderBarAreThoseOfTheFormulas) {
  const double length_m = 0.4, wide_m = 12e-3, high_m = 8e-3;
  const BodyModes body = modesOf({length_m, wide_m, high_m});
  EXPECT_NEAR(body.mass_kg, length_m * wide_m * high_m * kDensity_kg_m3, 1e-12);
  EXPECT_NEAR(body.surface_m2, 2 * (length_m * (wide_m + high_m) + wide_m * high_m), 1e-12);
  for (const double x : {4.730041, 7.853205, 10.995608}) {
    EXPECT_LT(missed(body, bendingHz(x, length_m, high_m)), kBar) << x;
    EXPECT_LT(missed(body, bendingHz(x, length_m, wide_m)), kBar) << x;
  }
  EXPECT_NEAR(body.frequency_hz[0], bendingHz(4.730041, length_m, high_m), kBar * body.frequency_hz[0])
      << "and there is none below the first";
  // The first longitudinal mode has half a wave in the bar.
  EXPECT_LT(missed(body, std::sqrt(kSteel.youngs_modulus_Pa / kDensity_kg_m3) / (2 * length_m)), kBar);
  // Torsion of a rectangle: Roark's formula for the torsion constant.
  const double a = wide_m / 2, b = high_m / 2;
  const double J = a * b * b * b * (16 / 3.0 - 3.36 * b / a * (1 - std::pow(b / a, 4) / 12));
  const double polar = wide_m * high_m * (wide_m * wide_m + high_m * high_m) / 12;
  const double shear_Pa = kSteel.youngs_modulus_Pa / (2 * (1 + kSteel.poissons_ratio));
  EXPECT_LT(missed(body, std::sqrt(shear_Pa * J / (kDensity_kg_m3 * polar)) / (2 * length_m)), kBar);
}

TEST(Modes, OfAFreeSquarePlateAreThoseOfLeissa) {
  const double edge_m = 0.2, thick_m = 3e-3;
  const BodyModes body = modesOf({edge_m, edge_m, thick_m});
  const double nu = kSteel.poissons_ratio;
  const double D = kSteel.youngs_modulus_Pa * std::pow(thick_m, 3) / (12 * (1 - nu * nu));
  // Leissa, "The free vibration of rectangular plates", J. Sound Vib. 31, 1973, table C21, nu = 0.3.
  const std::vector<double> lambda = {13.489, 19.789, 24.432, 35.024, 35.024};
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    const double hz = lambda[i] / (2 * kPi * edge_m * edge_m) * std::sqrt(D / (kDensity_kg_m3 * thick_m));
    EXPECT_NEAR(body.frequency_hz[i] / hz, 1, kBar) << i;
  }
}

TEST(Modes, AShapeIsOrthogonalAndHasMassOne) {
  const BodyModes body = modesOf({0.2, 0.04, 0.03});
  ASSERT_GE(body.frequency_hz.size(), 1u);
  // Bending moves the ends of the bar against its middle.
  const auto moved = [&](double x) { return body.shapesAt({x, 0, 0.015})[0].norm(); };
  const double end = moved(-0.1), middle = moved(0);
  EXPECT_GT(end, middle);
  EXPECT_GT(middle, 0);
  // The first bending mode of a slender free bar moves its ends by 2 / sqrt(mass) and its middle by 1.216 /
  // sqrt(mass) (Rao, section 8.5). This bar is thick, and shear reduces its bending.
  EXPECT_NEAR(end * std::sqrt(body.mass_kg), 2, 0.1);
  EXPECT_NEAR(middle * std::sqrt(body.mass_kg), 1.216, 0.1);
  // The motion is along the normal on the two faces perpendicular to the bending, and nearly tangential on
  // the other faces.
  const double bent_share = 0.04 / (0.04 + 0.03 + 0.04 * 0.03 / 0.2);
  EXPECT_NEAR(body.normal_rms[0] * std::sqrt(body.mass_kg), std::sqrt(bent_share), 0.06);
  // A point outside the body moves with the body's nearest point.
  EXPECT_EQ(body.shapesAt({0.1, 0, 0.0151})[0], body.shapesAt({0.1, 0, 0.015})[0]);
}

TEST(Modes, ARoundBarIsFoundOnASquareGrid) {
  const double length_m = 0.3, radius_m = 8e-3;
  const BodyModes body = findModes(
      makeCylinder(radius_m, length_m, 64),
      [&](const Vec3& p) { return std::hypot(p.x(), p.y()) < radius_m; }, kDensity_kg_m3, kSteel);
  const double hz = std::pow(4.730041 / length_m, 2) / (2 * kPi) * radius_m / 2 *
                    std::sqrt(kSteel.youngs_modulus_Pa / kDensity_kg_m3);
  EXPECT_LT(missed(body, hz), kBar);
}

/// In-plane bending of a thin ring of rectangular section, with n waves around it. The formula neglects shear
/// and rotary inertia, which lower the frequencies of n = 2 and 3 by about (n h / R)^2 / 12, here 1 and 2 %.
/// Source: Rayleigh, "The Theory of Sound", 1894, section 233.
double ringHz(int n, double radius_m, double thick_m) {
  const double second_moment_m2 =
      thick_m * thick_m / 12;  // second moment of the section, divided by its area
  return n * (n * n - 1) / std::sqrt(n * n + 1.0) / (2 * kPi * radius_m * radius_m) *
         std::sqrt(kSteel.youngs_modulus_Pa * second_moment_m2 / kDensity_kg_m3);
}

/// Modes of a tube about z with its centre at the origin.
BodyModes modesOfTube(double radius_m, double thick_m, double high_m) {
  return findModes(
      makeTube(radius_m + thick_m / 2, radius_m - thick_m / 2, high_m, 96),
      [&](const Vec3& p) { return std::abs(std::hypot(p.x(), p.y()) - radius_m) < thick_m / 2; },
      kDensity_kg_m3, kSteel);
}

TEST(Modes, ARingsAreThoseOfRayleigh) {
  const double radius_m = 0.05, thick_m = 8e-3, high_m = 12e-3;
  const BodyModes ring = modesOfTube(radius_m, thick_m, high_m);
  EXPECT_NEAR(ring.mass_kg, 2 * kPi * radius_m * thick_m * high_m * kDensity_kg_m3, 0.01 * ring.mass_kg);
  for (const int n : {2, 3}) EXPECT_LT(missed(ring, ringHz(n, radius_m, thick_m)), kBar) << n;
}

test::ThinShell bowlShell(double radius_m, double thick_m) {
  return {[radius_m](double s_m) {
            const double angle = s_m / radius_m;
            return test::Meridian{radius_m * std::sin(angle), std::cos(angle), 1 / radius_m, 1 / radius_m};
          },
          kPi / 2 * radius_m, true, thick_m};
}

/// A hemispherical bowl that bends without stretching, with n waves around its rim. Its displacements along
/// the meridian, around it and normal to the surface are sin t, sin t and n + cos t, times tan(t / 2)^n;
/// curvatures and twist change by (n^3 - n) tan(t / 2)^n / (a sin t)^2. Source: Rayleigh, "The Theory of
/// Sound", 1894, section 235 d.
double rayleighsBowlHz(int n, double radius_m, double thick_m) {
  constexpr int kSteps = 2000;
  double bending = 0, motion = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps * kPi / 2, sine = std::sin(t),
                 waves = std::pow(std::tan(t / 2), 2 * n);
    bending += 2 * waves / std::pow(sine, 3);
    motion += (2 * sine * sine + std::pow(n + std::cos(t), 2)) * waves * sine;
  }
  const double stiffness_Nm =
      kSteel.youngs_modulus_Pa * std::pow(thick_m, 3) / (12 * (1 + kSteel.poissons_ratio));
  return (n * n * n - n) / (radius_m * radius_m) *
         std::sqrt(2 * stiffness_Nm * bending / (kDensity_kg_m3 * thick_m * motion)) / (2 * kPi);
}

TEST(Modes, TheTheoryOfThinShellsHasRayleighsFrequenciesOfAThinBowlAndOfATube) {
  const double a_m = 0.05, h_m = 5e-6;
  EXPECT_NEAR(rayleighsBowlHz(3, a_m, h_m) / rayleighsBowlHz(2, a_m, h_m), 2.8102, 1e-4)
      << "the value that Rayleigh printed";
  EXPECT_NEAR(rayleighsBowlHz(4, a_m, h_m) / rayleighsBowlHz(2, a_m, h_m), 5.4316, 1e-4);
  // A free edge lowers frequencies by a share that is proportional to sqrt(h / a): 0.4 % here, 7 % at 2 mm.
  for (const int n : {2, 3, 4}) {
    const double hz = test::shellFrequencies(bowlShell(a_m, h_m), n)[0];
    EXPECT_NEAR(hz / rayleighsBowlHz(n, a_m, h_m), 0.99, 0.015) << n;
  }
  // If the wall of a tube bends around the axis only, it is Rayleigh's ring with a plate's stiffness in place
  // of a bar's. Free ends are slightly softer.
  const double nu = kSteel.poissons_ratio;
  const test::ThinShell tube = {[=](double) { return test::Meridian{a_m, 0, 0, 1 / a_m}; }, 0.5, false, 2e-3};
  for (const int n : {2, 3})
    EXPECT_NEAR(test::shellFrequencies(tube, n)[0], ringHz(n, a_m, 2e-3) / std::sqrt(1 - nu * nu),
                0.01 * ringHz(n, a_m, 2e-3))
        << n;
}

TEST(Modes, ATubesAreThoseOfThinShells) {
  const double radius_m = 0.05, high_m = 0.08;
  for (const double thick_m : {5e-3, 2e-3}) {  // wall thickness, with bricks of 11.5 mm
    const BodyModes body = modesOfTube(radius_m, thick_m, high_m);
    EXPECT_LT(*std::ranges::max_element(body.grid.size_m), 0.013)
        << "the grid has as many bricks as are allowed";
    const test::ThinShell shell = {[=](double) {
                                     return test::Meridian{radius_m, 0, 0, 1 / radius_m};
                                   },
                                   high_m, false, thick_m};
    // For each number of waves, the first mode is uniform along the tube, and the second changes sign in its
    // middle.
    for (const int n : {2, 3, 4})
      for (const int i : {0, 1}) {
        const double hz = test::shellFrequencies(shell, n)[i];
        EXPECT_LT(missed(body, hz), kBar) << thick_m << ' ' << n << ' ' << i << ' ' << hz;
      }
  }
}

TEST(Modes, ABellsAreThoseOfThinShells) {
  const double radius_m = 0.05;
  for (const double thick_m : {5e-3, 3e-3, 2e-3}) {  // wall thickness, with bricks of 10.5 mm
    constexpr int kFlats = 24;
    std::vector<std::array<double, 2>> profile;
    for (const bool outside : {true, false})
      for (int i = 0; i <= kFlats; ++i) {
        const double angle = kPi / 2 * (outside ? i : kFlats - i) / kFlats;
        const double r = radius_m + (outside ? 0.5 : -0.5) * thick_m;
        const bool is_pole = angle == 0, is_rim = angle == kPi / 2;
        profile.push_back({is_pole ? 0 : r * std::sin(angle), is_rim ? 0 : -r * std::cos(angle)});
      }
    const BodyModes body = findModes(
        test::lathe(profile, 96),
        [&](const Vec3& p) { return p.z() < 0 && std::abs(p.norm() - radius_m) < thick_m / 2; },
        kDensity_kg_m3, kSteel);
    EXPECT_NEAR(body.surface_m2, 4 * kPi * radius_m * radius_m + 2 * kPi * radius_m * thick_m,
                0.01 * body.surface_m2);
    for (const int n : {2, 3, 4}) {
      const double hz = test::shellFrequencies(bowlShell(radius_m, thick_m), n)[0];
      EXPECT_LT(missed(body, hz), kBar) << thick_m << ' ' << n << ' ' << hz;
      // Modes come in pairs: one is the other, rotated by a quarter of a wave.
      EXPECT_LT(std::abs(body.frequency_hz[2 * n - 3] / body.frequency_hz[2 * n - 4] - 1), 0.01) << n;
    }
    EXPECT_LT(std::abs(body.frequency_hz[0] / test::shellFrequencies(bowlShell(radius_m, thick_m), 2)[0] - 1),
              kBar)
        << "and there is none below the first";
  }
}

TEST(Modes, ACutBrickIsAsStiffAndHeavyAsWhatFillsIt) {
  // Only the lower half of the brick is filled. Stretched along x, the half-filled brick resists with half
  // the force of a whole brick.
  const Vec3 size_m(2e-3, 3e-3, 4e-3);
  BrickFilling half;
  half.addShares(-Vec3::Ones(), Vec3::Ones(), 8, [](int, int, int z) { return z < 4; });
  Eigen::Matrix<double, 3 * kBrickNodes, 1> stretched, turned;
  for (int i = 0; i < kBrickNodes; ++i)
    for (int k = 0; k < 3; ++k) {
      const double at_m = brickNode(i)[k] * size_m[k] / 2;
      stretched[3 * i + k] = k == 0 ? 1e-3 * at_m : -kSteel.poissons_ratio * 1e-3 * at_m;
      turned[3 * i + k] = k == 2 ? 0 : (k == 0 ? -1e-3 : 1e-3) * brickNode(i)[1 - k] * size_m[1 - k] / 2;
    }
  const BrickMatrices whole = brickMatrices(size_m, kSteel, wholeBrick()),
                      cut = brickMatrices(size_m, kSteel, half);
  const double whole_J = stretched.dot(whole.stiffness_N_per_m * stretched);
  EXPECT_NEAR(whole_J, kSteel.youngs_modulus_Pa * 1e-6 * size_m.prod(), 1e-9 * whole_J)
      << "E strain^2 volume";
  EXPECT_NEAR(stretched.dot(cut.stiffness_N_per_m * stretched), whole_J / 2, 1e-9 * whole_J);
  EXPECT_NEAR(turned.dot(cut.stiffness_N_per_m * turned), 0, 1e-9 * whole_J);
  EXPECT_NEAR(whole.mass_share_m3.sum(), size_m.prod(), 1e-12 * size_m.prod());
  EXPECT_NEAR(cut.mass_share_m3.sum(), size_m.prod() / 2, 1e-12 * size_m.prod());
  EXPECT_NEAR(brickShapes(Vec3(0.3, -0.7, 0.1)).sum(), 1, 1e-12);
}

TEST(Modes, AWallWithinABrickBendsAsAPlateDoes) {
  // A wall that is bent to curvature 1 about y, with the anticlastic curvature of free edges, stores the
  // energy E I / 2 per length.
  const Vec3 size_m(10e-3, 10e-3, 10e-3);
  const auto energy_J = [&](int from, int to) {
    BrickFilling wall;
    wall.addBox(Vec3(-1, -1, from / 6.0 - 1), Vec3(1, 1, to / 6.0 - 1));
    const double middle_m = (from + to) / 24.0 * size_m.z();
    Eigen::Matrix<double, 3 * kBrickNodes, 1> bent;
    for (int i = 0; i < kBrickNodes; ++i) {
      Vec3 p = size_m.cwiseProduct(Vec3(brickNode(i)[0], brickNode(i)[1], brickNode(i)[2])) / 2;
      p.z() -= middle_m;
      const double nu = kSteel.poissons_ratio;
      bent.segment<3>(3 * i) << -p.z() * p.x(), nu * p.y() * p.z(),
          (p.x() * p.x() + nu * (p.z() * p.z() - p.y() * p.y())) / 2;
    }
    return 0.5 * bent.dot(brickMatrices(size_m, kSteel, wall).stiffness_N_per_m * bent);
  };
  for (const auto& [from, to] : {std::pair(0, 12), std::pair(3, 5), std::pair(10, 11)}) {
    const double thick_m = (to - from) * size_m.z() / 12;
    const double theory_J = kSteel.youngs_modulus_Pa * size_m.x() * size_m.y() * std::pow(thick_m, 3) / 24;
    EXPECT_NEAR(energy_J(from, to), theory_J, 1e-6 * theory_J) << from << ' ' << to;
  }
}

TEST(Modes, WhatIsSmallOrEmptyHasNone) {
  EXPECT_TRUE(modesOf({8e-3, 8e-3, 12e-3}).frequency_hz.empty())
      << "the frequencies of a small peg are above the limit of hearing";
  EXPECT_TRUE(modesOf({0, 1, 1}).frequency_hz.empty());
  EXPECT_TRUE(findModes(
                  makeBox({1, 1, 1}), [](const Vec3&) { return false; }, 1, kSteel)
                  .frequency_hz.empty());
}

}  // namespace
}  // namespace vps::viewer
