// SPDX-License-Identifier: BSD-3-Clause
// A plan takes threads, seals and inserts from the check, and obeys the same refusals and declarations.
#include <gtest/gtest.h>

#include "scenes/assemblies_to_plan.h"
#include "support/lathe.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

PlanResult planOfThread(double hole_m, const OverlapWishes& overlaps) {
  const std::vector<DrawnPart> parts = {at("plate", makeTube(20e-3, hole_m, 10e-3, 48), {0, 0, -5e-3}),
                                        at("screw", headed(4e-3, 15e-3, 7e-3, 4e-3), {0, 0, 0})};
  PlanSettings settings;
  settings.fixed = {"plate"};
  settings.overlaps = overlaps;
  return planAssembly("test", parts, settings);
}

TEST(KnownOverlapsPlan, AThreadIsRefusedAndDeclaredAsInTheCheck) {
  EXPECT_EQ(planOfThread(3.3235e-3, {}).choices.at(0).kind, OverlapKind::Thread);
  EXPECT_EQ(planOfThread(3.3235e-3, {.is_strict = true}).choices.at(0).kind, OverlapKind::Clash);
  // 7.3 mm is the hole of no thread of 8 mm, but smaller by 9 %.
  EXPECT_EQ(planOfThread(3.65e-3, {}).choices.at(0).kind, OverlapKind::Clash);
  const OverlapWishes declared{.rules = {{{"screw", "plate", "here"}, OverlapWish::Thread, {}}}};
  const PlanResult plan = planOfThread(3.65e-3, declared);
  EXPECT_EQ(plan.choices.at(0).kind, OverlapKind::Thread);
  EXPECT_EQ(plan.choices.at(0).changed, "screw");
}

TEST(KnownOverlapsPlan, AnInsertIsMadeThinner) {
  const std::vector<DrawnPart> parts = {
      at("housing", makeTube(10e-3, 2e-3, 8e-3, 48), {0, 0, 0}),
      at("heat-set insert", makeTube(2.2e-3, 1.25e-3, 5e-3, 48), {0, 0, 1.5e-3})};
  const PlanResult plan = planAssembly("test", parts);
  ASSERT_EQ(plan.choices.size(), 1U);
  EXPECT_EQ(plan.choices[0].kind, OverlapKind::Insert);
  EXPECT_EQ(plan.choices[0].changed, "heat-set insert");
  EXPECT_EQ(plan.blocked(), 0U);
}

}  // namespace
}  // namespace vps::scenes
