// SPDX-License-Identifier: BSD-3-Clause
// Parts that leave only by a tilt, by the use of their play, or by a screw motion that no thread announces;
// and the same parts made so that they cannot leave.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "check/check_placed.h"
#include "scenes/assemblies_by_contact.h"
#include "support/units.h"
#include "surface/placed_surface.h"
#include "vps_scenes/planning/plan.h"
#include "ways/way.h"

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

/// The work of the search that leads a helical gear out of its mate.
std::uint64_t workOfContactWay(const std::vector<DrawnPart>& parts, std::uint64_t most) {
  CheckSettings settings;
  settings.has_play = false;
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, {});
  const CheckResult checked = checkPlaced("test", placed, settings, {});
  const PairMotions motions(placed, checked, Vec3::UnitZ(), {});
  SearchWork work{most, 0};
  EXPECT_TRUE(contactWay(motions, 1, {0}, work).has_value()) << "after " << work.done;
  return work.done;
}

TEST(ContactWays, AScrewAsksOnlyTeethThatCanMeet) {
  // Backlash of 134 um, as a drawing states it. Without the angles and phases of the facets, the search took
  // 2.71 million visits for 19,200 triangles; with them it takes 1.34 million.
  test::GearShape shape = helicalShape();
  shape.teeth = 20;
  shape.backlash_m = 134 * kUm;
  shape.points_per_tooth = 24;
  shape.axial_steps = 8;
  const std::vector<DrawnPart> parts = helicalPair(20 * std::numbers::pi / 180, shape);
  ASSERT_EQ(parts[1].mesh.triangles.size(), 19200U);
  EXPECT_LT(workOfContactWay(parts, 4'000'000), 1'700'000U);
}

}  // namespace
}  // namespace vps::scenes
