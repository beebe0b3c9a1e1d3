// SPDX-License-Identifier: BSD-3-Clause
// A long rod is held far from the holes that guide it.
#include <gtest/gtest.h>

#include "rod_scenes.h"
#include "vps_scenes/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult assembled(double clearance_m, std::uint64_t seed) {
  scenes::Scene scene = levelRod(clearance_m, seed);
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return scenes::assemble(scene, options).steps.at(0);
}

TEST(LevelRod, GoesThroughTwoHolesThatAreALittleWider) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const scenes::StepResult step = assembled(50e-6, seed);
    EXPECT_EQ(step.verdict, scenes::Verdict::Fits) << "seed " << seed << ": " << step.reason;
    EXPECT_TRUE(step.by_contact) << "seed " << seed;
  }
}

TEST(LevelRod, DoesNotGoThroughHolesThatAreALittleNarrower) {
  const scenes::StepResult step = assembled(-50e-6, 1);
  EXPECT_EQ(step.verdict, scenes::Verdict::Blocked) << step.reason;
  EXPECT_FALSE(step.completed);
  EXPECT_FALSE(step.by_contact);
}

}  // namespace
}  // namespace vps::hand
