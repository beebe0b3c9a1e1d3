// SPDX-License-Identifier: BSD-3-Clause
// Margins of a peg in its hole whose clearance is known by construction.
#include "vps_scenes/planning/margin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/peg_in_cup.h"
#include "vps/errors.h"

namespace vps::scenes {
namespace {

/// Distance between the flats of peg and cup; the radii are those of the corners.
double gapOf(const PegInCup& of) {
  return (of.bore_m - of.peg_m) * std::cos(std::numbers::pi / of.flats);
}

MarginOptions byGeometry(double resolution_m = 0.25e-6) {
  MarginOptions options;
  options.resolution_m = resolution_m;
  options.has_contact = false;
  return options;
}

/// Rounding of the meshes' coordinates and of the fit detected on them.
constexpr double kRounding_m = 0.05e-6;

class MarginByGeometry : public testing::TestWithParam<PegInCup> {};

// Every face moves outwards by the growth, so that the margin is the gap on each side: half of the diametral
// clearance.
TEST_P(MarginByGeometry, IsTheGapOnEachSide) {
  const MarginOptions options = byGeometry();
  const MarginResult result = measureMargins(pegInCup(GetParam()), options);
  ASSERT_EQ(result.steps.size(), 1U);
  const StepMargin& step = result.steps[0];
  EXPECT_TRUE(step.goes);
  EXPECT_EQ(step.part, "peg");
  const double gap_m = gapOf(GetParam());
  EXPECT_LE(step.growth_m, gap_m + kRounding_m);
  EXPECT_GE(step.growth_m, gap_m - options.resolution_m - kRounding_m);
  ASSERT_TRUE(step.growth_fails_m.has_value());
  EXPECT_LE(*step.growth_fails_m - step.growth_m, options.resolution_m);
  EXPECT_GE(*step.growth_fails_m, gap_m - kRounding_m);
  EXPECT_EQ(step.fails_as, Verdict::Blocked);
  EXPECT_NE(step.fails_why.find("cup"), std::string::npos) << step.fails_why;
  EXPECT_EQ(step.runs, 0U);
}

// A displacement across the path makes the peg touch after the same gap. A rotation makes an edge of the
// length inside the bore touch. The angle is at most the gap over half of the length inside the bore
// (rotation about the middle) and at least the gap over the whole length.
TEST_P(MarginByGeometry, HasThePlayAcrossThePath) {
  const MarginResult result = measureMargins(pegInCup(GetParam()), byGeometry());
  const StepMargin& step = result.steps[0];
  const double gap_m = gapOf(GetParam());
  ASSERT_TRUE(step.position_m.has_value());
  // The corners of the square are on the axes, so the peg moves along its diagonals.
  const double along_axis_m = GetParam().flats == 4 ? gap_m * std::sqrt(2.0) : gap_m;
  EXPECT_NEAR(*step.position_m, along_axis_m, step.position_error_m + kRounding_m);
  EXPECT_NEAR(step.position_W.z(), 0, 1e-6);
  ASSERT_TRUE(step.angle_rad.has_value());
  EXPECT_GE(*step.angle_rad, gap_m / GetParam().depth_m);
  EXPECT_LE(*step.angle_rad, 2.5 * gap_m / (GetParam().depth_m - 2 * GetParam().chamfer_m));
}

INSTANTIATE_TEST_SUITE_P(OfARoundAndASquarePeg, MarginByGeometry,
                         testing::Values(PegInCup{}, PegInCup{4.02e-3, 4e-3}, PegInCup{4.05e-3, 4e-3, 4}),
                         [](const auto& info) {
                           return (info.param.flats == 4 ? "Square" : "Round") +
                                  std::to_string(std::lround(1e6 * (info.param.bore_m - info.param.peg_m)));
                         });

// By contact, the margin never exceeds that of geometry, and is at most 10 um smaller, the depth at which
// contacts begin.
TEST(Margin, ByContactIsAtMostThatOfGeometryAndLessByNoMoreThanTheContactsDepth) {
  const PegInCup of{4.03e-3, 4e-3};
  MarginOptions options;
  options.resolution_m = 2e-6;
  const MarginResult result = measureMargins(pegInCup(of), options);
  const StepMargin& step = result.steps[0];
  EXPECT_TRUE(step.goes) << step.fails_why;
  EXPECT_GE(step.runs, 2U);
  EXPECT_LE(step.growth_m, gapOf(of) + kRounding_m);
  EXPECT_GE(step.growth_m, gapOf(of) - 10e-6 - options.resolution_m);
}

TEST(Margin, OfAPartThatIsTooLargeIsNone) {
  const MarginResult result = measureMargins(pegInCup({3.99e-3, 4e-3}), byGeometry());
  const StepMargin& step = result.steps[0];
  EXPECT_FALSE(step.goes);
  EXPECT_EQ(step.fails_as, Verdict::Blocked);
  EXPECT_EQ(step.growth_m, 0);
  EXPECT_FALSE(step.position_m.has_value());
}

TEST(Margin, OfTheTightestStepStandsFirst) {
  Scene scene = pegInCup({});
  const Scene tight = pegInCup({4.02e-3, 4e-3});
  for (ScenePart part : tight.parts) {
    part.part.name += "2";
    part.X_WP.p.x() += 50e-3;
    scene.parts.push_back(part);
  }
  SceneStep step = tight.steps[0];
  step.part = 3;
  step.X_WP_start.p.x() += 50e-3;
  step.X_WP_target.p.x() += 50e-3;
  scene.steps.push_back(step);
  const MarginResult result = measureMargins(scene, byGeometry(1e-6));
  ASSERT_EQ(result.steps.size(), 2U);
  EXPECT_EQ(result.steps[0].part, "peg2");
  EXPECT_EQ(result.steps[0].step, 1U);
  EXPECT_EQ(result.steps[1].part, "peg");
}

TEST(Margin, NeedsAResolution) {
  EXPECT_THROW(measureMargins(pegInCup({}), byGeometry(0)), LoadError);
}

}  // namespace
}  // namespace vps::scenes
