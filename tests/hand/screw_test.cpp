// SPDX-License-Identifier: BSD-3-Clause
// A nut is screwed on by feel, with the threads' true geometry.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hand_scenes.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

scenes::StepResult assembled(const scenes::Scene& scene, int judge_stride = 500) {
  scenes::Scene copy = scene;
  scenes::AssembleOptions options;
  options.judge_stride = judge_stride;
  return scenes::assemble(copy, options).steps.at(0);
}

TEST(Screw, ANutIsTurnedBackUntilItDropsAndThenScrewedOn) {
  // The run is judged often enough to see the end of the nut's thread pass the end of the bolt's, which takes
  // ten ticks: the field reads up to 30 um too much at these ends, and the nut once was 12 um deep.
  const scenes::StepResult step = assembled(coarseThread(4.5e-3, 1), 10);
  EXPECT_EQ(step.verdict, scenes::Verdict::Fits) << step.reason;
  std::vector<std::string> order;
  for (const scenes::StrategyUse& use : step.strategies) order.push_back(use.strategy);
  EXPECT_EQ(order, (std::vector<std::string>{"approach", "touch", "turn_back", "screw_on"}));
  // 4.5 mm less the chamfers, in which the nut drops, is about a turn. The play of 0.17 mm is 6 % of the
  // pitch, and the advance through the chamfers does not follow the thread.
  EXPECT_NEAR(step.turns, 1, 0.3);
  EXPECT_NEAR(step.advance_per_turn_m, 3e-3, 0.2 * 3e-3);
  EXPECT_GT(step.index_count, 4);  // a turn back and a turn forward, in segments of 78 degrees
  EXPECT_TRUE(step.by_contact);
}

TEST(Screw, WithoutAThreadNothingCatches) {
  scenes::Scene scene = smoothRod(4.5e-3, 1);
  scene.steps[0].timeout_s = 20;
  const scenes::StepResult step = assembled(scene);
  EXPECT_EQ(step.verdict, scenes::Verdict::NotShown);
  EXPECT_NE(step.reason.find("no contact like that of a thread stopped it"), std::string::npos)
      << step.reason;
}

}  // namespace
}  // namespace vps::hand
