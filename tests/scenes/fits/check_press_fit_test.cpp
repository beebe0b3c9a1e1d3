// SPDX-License-Identifier: BSD-3-Clause
// Declared interference fits whose sizes are known by construction, and the press force by Lame's formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fits/press_fit.h"
#include "support/lathe.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

const CheckSettings kPressFits{.has_fits = true, .has_play = false};

DrawnPart pressedPart(const std::string& name, const Mesh& mesh, double press_fit_m = 0) {
  DrawnPart out{name, mesh, Pose(), {}, false};
  out.press_fit_m = press_fit_m;
  return out;
}

/// A ring with a bore of 20 mm, an outer diameter of 40 mm and a length of 30 mm, and a pin in it whose
/// diameter is larger by a given interference.
CheckResult ringAndPin(double interference_m, double declared_m, int segments = 720,
                       const CheckSettings& settings = kPressFits) {
  const Mesh pin = makeCylinder(10e-3 + interference_m / 2, 50e-3, segments);
  return checkAssembly(
      "test",
      {pressedPart("ring", makeTube(20e-3, 10e-3, 30e-3, segments)), pressedPart("pin", pin, declared_m)},
      settings);
}

// For a solid steel shaft and a hub of twice its diameter, p = delta E / (d (5/3 + 1)), since nu cancels.
TEST(CheckPressFit, ThePressureOfASolidShaftInARingOfTwiceItsDiameterIsThatOfTheFormula) {
  const PressedRing ring{20e-3, 40e-3, 0, 30e-3, 0.15, 210e9, 0.3, 210e9, 0.3};
  EXPECT_NEAR(jointPressure(ring, 20e-6), 20e-6 * 210e9 / (20e-3 * 8 / 3), 1);
  // After Shigley, example 3-14: both parts have one material, and the hollow shaft's hole has half the
  // joint's diameter.
  const PressedRing hollow{20e-3, 40e-3, 10e-3, 30e-3, 0.15, 210e9, 0.3, 210e9, 0.3};
  EXPECT_NEAR(jointPressure(hollow, 20e-6), 20e-6 * 210e9 / (20e-3 * 10 / 3), 1);
}

TEST(CheckPressFit, AnOverlapUpToTheDeclaredOneIsAPressFitAndMoreIsAClash) {
  for (const double drawn_m : {5e-6, 15e-6, 19e-6, 21.5e-6, 40e-6}) {
    const CheckResult result = ringAndPin(drawn_m, 20e-6);
    ASSERT_EQ(result.pairs.size(), 1U);
    EXPECT_EQ(result.pairs[0].state, drawn_m < 20e-6 ? PairState::PressFit : PairState::Clash) << drawn_m;
    EXPECT_EQ(result.clashes(), drawn_m < 20e-6 ? 0U : 1U);
    ASSERT_EQ(result.fits.size(), 1U);
    EXPECT_NEAR(result.fits[0].diametral_clearance_m, -drawn_m, 1e-12);
    EXPECT_EQ(result.pairs[0].press_fit_m, 20e-6);
  }
  EXPECT_EQ(ringAndPin(15e-6, 0).pairs.at(0).state, PairState::Clash);
  EXPECT_EQ(ringAndPin(-15e-6, 20e-6).pairs.at(0).state, PairState::Apart);
}

TEST(CheckPressFit, PressureAndForceAreThoseOfLame) {
  const CheckResult result = ringAndPin(15e-6, 20e-6);
  ASSERT_TRUE(result.fits.at(0).press);
  const CheckedPress& press = *result.fits[0].press;
  // The ring is measured on facets, whose middles are inside the cylinder by 1 - cos(pi / 720), 1e-5 of its
  // size.
  EXPECT_NEAR(press.hub_m, 40e-3, 1e-6);
  EXPECT_EQ(press.hole_m, 0);
  const double pressure_Pa = 15e-6 * 210e9 / (20e-3 * 8 / 3);
  // The joint is larger than the bore by 7.5 um in 10 mm, and the ring is smaller by 1e-5.
  EXPECT_NEAR(press.pressure_Pa, pressure_Pa, 2e-3 * pressure_Pa);
  const double force_N = 0.15 * pressure_Pa * std::numbers::pi * 20e-3 * 30e-3;
  EXPECT_NEAR(press.force_N, force_N, 3e-3 * force_N);  // 16.7 kN
  EXPECT_NEAR(press.declared_force_N, press.force_N * 20 / 15, 1e-6 * force_N);
  EXPECT_NEAR(press.hub_stress_Pa, pressure_Pa * 8 / 3, 4e-3 * pressure_Pa);
}

TEST(CheckPressFit, AHollowShaftAndOtherMaterialsGiveWay) {
  const Mesh ring = makeTube(20e-3, 10e-3, 30e-3, 720);
  DrawnPart sleeve = pressedPart("sleeve", makeTube(10.01e-3, 5e-3, 50e-3, 720), 30e-6);
  sleeve.youngs_modulus_Pa = 70e9;
  sleeve.poissons_ratio = 0.33;
  sleeve.friction = 0.6;
  const CheckResult result = checkAssembly("test", {pressedPart("ring", ring), sleeve}, kPressFits);
  ASSERT_TRUE(result.fits.at(0).press);
  const CheckedPress& press = *result.fits[0].press;
  EXPECT_NEAR(press.hole_m, 10e-3, 1e-6);
  const double give = (5.0 / 3 + 0.3) / 210e9 + (5.0 / 3 - 0.33) / 70e9;
  EXPECT_NEAR(press.pressure_Pa, 20e-6 / (20e-3 * give), 4e-3 * press.pressure_Pa);
  EXPECT_NEAR(press.friction, 0.3, 1e-12);  // sqrt(0.15 * 0.6)
}

// Facets of 2 degrees are 1.5 um inside the true cylinders; facets of 10 degrees are 38 um inside.
TEST(CheckPressFit, AnInterferenceThatTheFacetsHideIsSeenFromTheirCorners) {
  const CheckResult hidden = ringAndPin(10e-6, 0, 36);
  const CheckResult as_meshes =
      checkAssembly("test",
                    {pressedPart("ring", makeTube(20e-3, 10e-3, 30e-3, 36)),
                     {"pin",
                      makeCylinder(10e-3 + 5e-6, 50e-3, 36),
                      Pose(rotationFromVector(Vec3(0, 0, std::numbers::pi / 36)), Vec3::Zero()),
                      {},
                      false}},
                    kPressFits);
  for (const CheckResult* result : {&hidden, &as_meshes}) {
    EXPECT_EQ(result->pairs.at(0).state, PairState::Clash);
    EXPECT_NEAR(result->pairs[0].interference_depth_m, 5e-6, 0.1e-6);
    // The shared volume is a ring between the cylinders, 30 mm long, with material all around. Only the radii
    // have an error.
    const double ring_m3 = std::numbers::pi * (10.005e-3 * 10.005e-3 - 10e-3 * 10e-3) * 30e-3;
    EXPECT_NEAR(result->pairs[0].interference_volume_m3, ring_m3, result->pairs[0].volume_error_m3);
    EXPECT_LT(result->pairs[0].volume_error_m3, 0.01 * ring_m3);
  }
  EXPECT_EQ(ringAndPin(10e-6, 0, 36, {.has_fits = false, .has_play = false}).clashes(), 1U);
  EXPECT_EQ(ringAndPin(10e-6, 15e-6, 36).pairs.at(0).state, PairState::PressFit);
  EXPECT_EQ(ringAndPin(0, 0, 36).pairs.at(0).state, PairState::Contact);
}

TEST(CheckPressFit, ABlockPressedInWithoutAFitIsJudgedByItsDepth) {
  const auto check = [](double depth_m) {
    DrawnPart block = pressedPart("block", makeBox(Vec3(0.01, 0.02, 0.03)), 20e-6);
    block.X_WP = Pose::translation(Vec3(0.02, 0.01, 0.015 - depth_m));
    return checkAssembly("test",
                         {pressedPart("plate", transformed(makeBox(Vec3(0.1, 0.1, 0.02)),
                                                           Pose::translation(Vec3(0, 0, -0.01)))),
                          block},
                         kPressFits)
        .pairs.at(0)
        .state;
  };
  EXPECT_EQ(check(19e-6), PairState::PressFit);
  EXPECT_EQ(check(21e-6), PairState::Clash);
}

// A pin that is drawn through the ring's wall is no press fit, even if its diameter has the declared
// interference.
TEST(CheckPressFit, ADeclaredPressFitDoesNotHideAnotherOverlap) {
  const Mesh seat =
      test::lathe({{0, -10e-3}, {20e-3, -10e-3}, {20e-3, 20e-3}, {10e-3, 20e-3}, {10e-3, 0}, {0, 0}}, 720);
  const auto check = [&](double below_m) {
    const Mesh pin =
        test::lathe({{0, -below_m}, {10.0075e-3, -below_m}, {10.0075e-3, 40e-3}, {0, 40e-3}}, 720);
    return checkAssembly("test", {pressedPart("seat", seat), pressedPart("pin", pin, 20e-6)}, kPressFits);
  };
  EXPECT_EQ(check(0).pairs.at(0).state, PairState::PressFit);
  EXPECT_EQ(check(100e-6).pairs.at(0).state, PairState::Clash);
}

}  // namespace
}  // namespace vps::scenes
