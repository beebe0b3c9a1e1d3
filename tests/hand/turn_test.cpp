// SPDX-License-Identifier: BSD-3-Clause
// A part with corners is turned about its axis until it finds its hole.
#include <gtest/gtest.h>

#include <algorithm>

#include "peg_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

TEST(TurnSearch, FindsAHoleThatIsTurnedFartherThanSightSays) {
  const auto& all = pegScenes();
  const auto turned = std::find_if(all.begin(), all.end(),
                                   [](const PegScene& s) { return std::string_view(s.name) == "turned"; });
  ASSERT_NE(turned, all.end());
  int searched = 0;
  for (std::uint64_t seed = 5; seed <= 7; ++seed) {  // those before find it by tilt or spiral
    scenes::Scene scene = turned->make(seed);
    scenes::AssembleOptions options;
    options.judge_stride = 1000;
    const scenes::StepResult step = scenes::assemble(scene, options).steps.at(0);
    EXPECT_TRUE(step.completed) << "seed " << seed << ": " << step.failure_reason;
    searched += std::any_of(step.strategies.begin(), step.strategies.end(),
                            [](const scenes::StrategyUse& use) { return use.strategy == "turn_search"; });
  }
  EXPECT_GT(searched, 0);
}

}  // namespace
}  // namespace vps::hand
