// SPDX-License-Identifier: BSD-3-Clause
// Parts that leave only by a tilt, by the use of their play, or by a screw motion that no thread announces;
// and the same parts made so that they cannot leave.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "scenes/assemblies_by_contact.h"
#include "support/units.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

PlanResult planOn(const std::string& base, const std::vector<DrawnPart>& parts) {
  PlanSettings settings;
  settings.fixed = {base};
  return planAssembly("test", parts, settings);
}

void expectLeaves(const std::vector<DrawnPart>& parts, const std::string& what) {
  const PlanResult plan = planOn("base", parts);
  EXPECT_EQ(plan.blocked(), 0U) << what;
  EXPECT_EQ(plan.steps(), 1U) << what;
  expectFreeWays(parts, plan);
}

void expectStays(const std::vector<DrawnPart>& parts, const std::string& what) {
  EXPECT_EQ(planOn("base", parts).blocked(), 1U) << what;
}

TEST(ContactWays, ACoverUnderALipTiltsOverTheWall) {
  for (const double room_m : {4.5 * kMm, 5.5 * kMm})
    expectLeaves(coverUnderLip(room_m), std::to_string(room_m));
  expectStays(coverUnderLip(3.1 * kMm), "with 0.1 mm of room");
}

TEST(ContactWays, ASlideWithPlayPassesANub) {
  expectLeaves(slideBeforeNub(100 * kUm, 60 * kUm), "100 um of play, a nub of 60");
  expectLeaves(slideBeforeNub(100 * kUm, 85 * kUm), "100 um of play, a nub of 85");
  expectLeaves(slideBeforeNub(1 * kMm, 0.8 * kMm), "1 mm of play, a nub of 0.8");
  expectStays(slideBeforeNub(100 * kUm, 150 * kUm), "100 um of play, a nub of 150");
}

TEST(ContactWays, AHelicalGearScrewsOutOfItsMate) {
  for (const double helix_deg : {-10.0, 20.0})
    expectLeaves(helicalPair(helix_deg * std::numbers::pi / 180), std::to_string(helix_deg));
}

}  // namespace
}  // namespace vps::scenes
