// SPDX-License-Identifier: BSD-3-Clause
// The virtual operator finds holes by feel. The shares of many seeds are in README.md; here a few.
#include <gtest/gtest.h>

#include <algorithm>

#include "hand/peg_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult stepOf(const char* name, std::uint64_t seed) {
  const auto& all = pegScenes();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const PegScene& s) { return std::string_view(s.name) == name; });
  scenes::Scene scene = found->make(seed);
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return scenes::assemble(scene, options).steps.at(0);
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
  // Sight alone errs by more than the 50 um on each side.
  EXPECT_GT(searched, 0);
}

}  // namespace
}  // namespace vps::hand
