// SPDX-License-Identifier: BSD-3-Clause
// "By contact" is said of a part that its neighbours guided, and not of one that was put down by sight.
#include <gtest/gtest.h>

#include "peg_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult stepOf(PegFit fit, std::uint64_t seed) {
  scenes::Scene scene = pegScene("peg", holeMesh(fit), pegMesh(fit), fit.depth_m, seed);
  scene.steps[0].tolerance_m = 1e-3;  // ten errors of sight: the hand alone is good enough for that
  scene.steps[0].tolerance_rad = 0.1;
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return scenes::assemble(scene, options).steps.at(0);
}

TEST(Guided, APegInItsBoreIsBroughtHomeByContactAndOnAPlateByNothing) {
  for (const bool is_round : {true, false})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      PegFit fit;
      fit.is_round = is_round;
      fit.clearance_m = 50e-6;
      fit.chamfer_m = 0.5e-3;
      const scenes::StepResult in_bore = stepOf(fit, seed);
      EXPECT_TRUE(in_bore.completed) << in_bore.failure_reason;
      EXPECT_TRUE(in_bore.by_contact) << in_bore.guide_force_N << " N";
      fit.has_wall = false;
      const scenes::StepResult on_plate = stepOf(fit, seed);
      EXPECT_TRUE(on_plate.completed) << on_plate.failure_reason;
      EXPECT_FALSE(on_plate.by_contact) << on_plate.guide_force_N << " N";
    }
}

}  // namespace
}  // namespace vps::hand
