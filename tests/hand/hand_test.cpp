// SPDX-License-Identifier: BSD-3-Clause
// The virtual operator finds holes by feel, and "by contact" is reported only for a part that contact guided.
// README.md has the shares of many seeds; these tests run a few seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "hand_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult stepOf(scenes::Scene scene) {
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return scenes::assemble(scene, options).steps.at(0);
}

scenes::StepResult stepOf(std::string_view name, std::uint64_t seed) {
  const auto& all = pegScenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const PegScene& s) { return s.name == name; });
  if (found == all.end()) throw std::invalid_argument("no peg scene is named '" + std::string(name) + "'");
  return stepOf(found->make(seed));
}

bool uses(const scenes::StepResult& step, std::string_view strategy) {
  return std::any_of(step.strategies.begin(), step.strategies.end(),
                     [&](const scenes::StrategyUse& use) { return use.strategy == strategy; });
}

TEST(Hand, ARoundPegWithTwentyMicrometresGoesHomeAndTheStrategiesAreNamedInOrder) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const scenes::StepResult step = stepOf("round", seed);
    EXPECT_TRUE(step.completed) << "seed " << seed << ": " << step.failure_reason;
    ASSERT_FALSE(step.strategies.empty());
    EXPECT_EQ(step.strategies.front().strategy, "approach");
    EXPECT_EQ(step.strategies.back().strategy, "press_home");
    for (std::size_t i = 1; i < step.strategies.size(); ++i)
      EXPECT_GE(step.strategies[i].start_s,
                step.strategies[i - 1].start_s + step.strategies[i - 1].duration_s);
  }
}

TEST(Hand, ASharpRectangularHoleIsSearchedAndFound) {
  int searched = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const scenes::StepResult step = stepOf("rectangular", seed);
    EXPECT_TRUE(step.completed) << "seed " << seed << ": " << step.failure_reason;
    searched += uses(step, "tilt_in") || uses(step, "spiral_search");
  }
  // The operator's see_error_m (0.1 mm) is greater than the clearance of 50 um on each side.
  EXPECT_GT(searched, 0);
}

TEST(TurnSearch, FindsAHoleThatIsTurnedFartherThanSightSays) {
  int searched = 0;
  for (std::uint64_t seed = 5; seed <= 7; ++seed) {  // the seeds 1 to 4 find the hole by tilt or spiral
    const scenes::StepResult step = stepOf("turned", seed);
    EXPECT_TRUE(step.completed) << "seed " << seed << ": " << step.failure_reason;
    searched += uses(step, "turn_search");
  }
  EXPECT_GT(searched, 0);
}

scenes::StepResult looseStep(const PegFit& fit, std::uint64_t seed) {
  scenes::Scene scene = pegScene("peg", holeMesh(fit), pegMesh(fit), fit.depth_m, seed);
  // Ten times see_error_m, a tolerance for which the hand alone is good enough.
  scene.steps[0].tolerance_m = 1e-3;
  scene.steps[0].tolerance_rad = 0.1;
  return stepOf(std::move(scene));
}

TEST(Guided, APegInItsBoreIsBroughtHomeByContactAndOnAPlateByNothing) {
  for (const bool is_round : {true, false})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      PegFit fit;
      fit.is_round = is_round;
      fit.clearance_m = 50e-6;
      fit.chamfer_m = 0.5e-3;
      const scenes::StepResult in_bore = looseStep(fit, seed);
      EXPECT_TRUE(in_bore.completed) << in_bore.failure_reason;
      EXPECT_TRUE(in_bore.by_contact) << in_bore.guide_force_N << " N";
      fit.has_wall = false;
      const scenes::StepResult on_plate = looseStep(fit, seed);
      EXPECT_TRUE(on_plate.completed) << on_plate.failure_reason;
      EXPECT_FALSE(on_plate.by_contact) << on_plate.guide_force_N << " N";
    }
}

}  // namespace
}  // namespace vps::hand
