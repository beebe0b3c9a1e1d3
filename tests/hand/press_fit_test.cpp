// SPDX-License-Identifier: BSD-3-Clause
// A pin that is assembled in: physics lets it pass, the judge allows the declared interference, and the
// result states the force.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hand_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

constexpr double kInterference_m = 10e-6;

/// An 8 mm pin, 10 um too large for its blind hole.
scenes::Scene pinScene(double declared_m, double youngs_modulus_Pa) {
  PegFit fit;
  fit.clearance_m = -kInterference_m;
  fit.chamfer_m = 0.5e-3;
  scenes::Scene scene = pegScene("pin", holeMesh(fit), pegMesh(fit), fit.depth_m, 1);
  scene.parts[1].press_fit_m = declared_m;
  for (scenes::ScenePart& part : scene.parts) part.youngs_modulus_Pa = youngs_modulus_Pa;
  return scene;
}

scenes::StepResult pressed(scenes::Scene scene) {
  scenes::AssembleOptions options;
  options.judge_stride = 100;
  return scenes::assemble(scene, options).steps.at(0);
}

// Lame's formula with d = 8 mm, D = 24 mm, a solid pin, and equal E and nu of both parts; length_m is the
// length of the fit between the chamfers of 0.5 mm.
double force_N(double modulus_Pa, double interference_m, double length_m) {
  const double d = 8e-3, D = 24e-3, share = d * d / (D * D), nu = 0.3;
  const double pressure_Pa = interference_m * modulus_Pa / d / ((1 + share) / (1 - share) + nu + 1 - nu);
  return pressure_Pa * std::numbers::pi * d * length_m * 0.15;
}

TEST(PressFit, ASteelPinFitsButTheHandIsNotStrongEnough) {
  const scenes::StepResult step = pressed(pinScene(12e-6, 210e9));
  EXPECT_TRUE(step.completed) << step.failure_reason;
  EXPECT_EQ(step.verdict, scenes::Verdict::NotShown);
  // 8.5 to 9.5 mm of the pin are in the bore; the flats of the bore add 0.03 % to its size.
  EXPECT_GT(step.press_needed_N, 0.98 * force_N(210e9, 12e-6, 8.5e-3));
  EXPECT_LT(step.press_needed_N, 1.02 * force_N(210e9, 12e-6, 9.5e-3));
  EXPECT_NE(step.reason.find(std::to_string(std::lround(step.press_needed_N)) + " N"), std::string::npos)
      << step.reason;
  EXPECT_NE(step.reason.find("the hand has 15 N"), std::string::npos) << step.reason;
  EXPECT_LT(step.max_penetration_m, step.penetration_limit_m);
}

TEST(PressFit, ASoftPinGoesIn) {
  const scenes::StepResult step = pressed(pinScene(12e-6, 0.5e9));
  EXPECT_LT(step.press_needed_N, 15);
  EXPECT_GT(step.press_needed_N, 0);
  EXPECT_EQ(step.verdict, scenes::Verdict::Fits) << step.reason;
}

TEST(PressFit, MoreThanDeclaredIsBlocked) {
  EXPECT_EQ(pressed(pinScene(0, 210e9)).verdict, scenes::Verdict::Blocked);
  EXPECT_EQ(pressed(pinScene(6e-6, 210e9)).verdict, scenes::Verdict::Blocked);
}

}  // namespace
}  // namespace vps::hand
