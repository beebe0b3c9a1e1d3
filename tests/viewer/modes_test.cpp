// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies against the formulas of bar, plate and ring. 3 %: below what an ear tells apart as
// another note (a semitone is 6 %).
#include "sound/modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

constexpr Elasticity kSteel;
constexpr double kDensity_kg_m3 = 7850, kPi = std::numbers::pi;
constexpr double kBar = 0.03;

Box boxOf(const Vec3& size_m) {
  return {-0.5 * size_m, 0.5 * size_m};
}
BodyModes modesOf(const Vec3& size_m, ModeSettings settings = {}) {
  return findModes(
      boxOf(size_m), [](const Vec3&) { return true; }, kDensity_kg_m3, kSteel, settings);
}
/// The share by which the nearest of the modes differs.
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
  // Lengthwise: half a wave in the bar.
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
  const auto corner = [&](double x) { return body.nearestCorner({2 * x, 0, 0.015}); };
  const float end = body.shape(0, corner(-0.05)).norm(), middle = body.shape(0, corner(0)).norm();
  EXPECT_GT(end, 0);
  EXPECT_GT(end, middle);
  // A mode of mass 1 moves a corner by about 1 / sqrt(mass).
  EXPECT_NEAR(std::log10(end * std::sqrt(body.mass_kg)), 0.3, 0.4);
}

TEST(Modes, ARoundBarIsFoundOnASquareGrid) {
  const double length_m = 0.3, radius_m = 8e-3;
  const BodyModes body = findModes(boxOf({length_m, 2 * radius_m, 2 * radius_m}),
                                   [&](const Vec3& p) { return std::hypot(p.y(), p.z()) < radius_m; },
                                   kDensity_kg_m3, kSteel, {.most_bricks = 1500, .least_across = 6});
  const double hz = std::pow(4.730041 / length_m, 2) / (2 * kPi) * radius_m / 2 *
                    std::sqrt(kSteel.youngs_modulus_Pa / kDensity_kg_m3);
  EXPECT_LT(missed(body, hz), kBar);
}

/// A ring of rectangular section about z: bending in its plane, in n waves around it. Rayleigh, "The Theory
/// of Sound", 1894, section 233. Of a thin ring: shear and rotary inertia, which it leaves out, lower n = 2
/// and 3 by about (n h / R)^2 / 12, here 1 and 2 %.
double ringHz(int n, double radius_m, double thick_m) {
  const double second_moment_m2 = thick_m * thick_m / 12;  // of the section, over its area
  return n * (n * n - 1) / std::sqrt(n * n + 1.0) / (2 * kPi * radius_m * radius_m) *
         std::sqrt(kSteel.youngs_modulus_Pa * second_moment_m2 / kDensity_kg_m3);
}

TEST(Modes, ARingsAreThoseOfRayleighOnAGridThatCutsItsWall) {
  const double radius_m = 0.05, thick_m = 8e-3, high_m = 12e-3;
  const Vec3 half_m(radius_m + thick_m / 2, radius_m + thick_m / 2, high_m / 2);
  const auto ring = [&](std::size_t most_bricks) {
    return findModes(
        {-half_m, half_m},
        [&](const Vec3& p) { return std::abs(std::hypot(p.x(), p.y()) - radius_m) < thick_m / 2; },
        kDensity_kg_m3, kSteel, {.most_bricks = most_bricks, .most_modes = 14});
  };
  const BodyModes fine = ring(1500), usual = ring(ModeSettings().most_bricks);
  EXPECT_NEAR(fine.mass_kg, 2 * kPi * radius_m * thick_m * high_m * kDensity_kg_m3, 0.01 * fine.mass_kg);
  for (const int n : {2, 3}) {
    const double hz = ringHz(n, radius_m, thick_m);
    EXPECT_LT(missed(fine, hz), kBar) << n;
    // Bricks of half the wall: the bending of a brick is exact only along its edges. The error of the finer
    // grid grows by the square of the bricks' size, (4.3 mm / 3.2 mm)^2 = 1.8.
    EXPECT_LT(missed(usual, hz), 1.8 * kBar) << n;
  }
}

TEST(Modes, ACutBrickIsAsStiffAndHeavyAsWhatFillsIt) {
  // The lower half of a brick: stretched along x it resists with half the whole brick's force.
  const Vec3 size_m(2e-3, 3e-3, 4e-3);
  BrickFilling half;
  const int across = 8;
  half.share_volume = 1.0 / (across * across * across);
  for (int i = 0; i < across * across * across / 2; ++i)
    half.at.emplace_back(
        2 * (Vec3(i % across, i / across % across, i / (across * across)).array() + 0.5).matrix() / across -
        Vec3::Ones());
  Eigen::Matrix<double, 24, 1> stretched;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) {
      const double at_m = (i >> k & 1) != 0 ? size_m[k] : 0;
      stretched[3 * i + k] = k == 0 ? 1e-3 * at_m : -kSteel.poissons_ratio * 1e-3 * at_m;
    }
  const double whole_J = stretched.dot(brickStiffness(size_m, kSteel) * stretched);
  EXPECT_NEAR(whole_J, kSteel.youngs_modulus_Pa * 1e-6 * size_m.prod(), 1e-9 * whole_J)
      << "E strain^2 volume";
  EXPECT_NEAR(stretched.dot(brickStiffness(size_m, kSteel, half) * stretched), whole_J / 2, 1e-9 * whole_J);
  const std::array<double, 8> shares = cornerShares(half);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(shares[i], i < 4 ? 3 / 32.0 : 1 / 32.0, 1e-12) << i;
}

TEST(Modes, WhatIsSmallOrEmptyHasNone) {
  EXPECT_TRUE(modesOf({8e-3, 8e-3, 12e-3}).frequency_hz.empty()) << "a small peg rings beyond hearing";
  EXPECT_TRUE(modesOf({0, 1, 1}).frequency_hz.empty());
  EXPECT_TRUE(findModes(
                  boxOf({1, 1, 1}), [](const Vec3&) { return false; }, 1, kSteel)
                  .frequency_hz.empty());
}

}  // namespace
}  // namespace vps::viewer
