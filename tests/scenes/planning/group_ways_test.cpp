// SPDX-License-Identifier: BSD-3-Clause
// Plugs that carry open rings on their necks: a wall holds the rings, so that they leave only together with
// their plug, straight, by a turn or along a thread; and plugs whose rings leave alone.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "check/check_placed.h"
#include "order/take_apart.h"
#include "scenes/assemblies_to_plan.h"
#include "support/screw.h"
#include "support/units.h"
#include "surface/placed_surface.h"
#include "vps_scenes/planning/plan.h"

namespace vps::scenes {
namespace {

enum class Hold { Straight, Bayonet };
enum class Carried {
  Ring,        ///< an open ring of 200 degrees
  TwoRings,    ///< two of them, one above the other, open to opposite sides
  Halves,      ///< the halves of a ring
  WideRing,    ///< a closed ring that the whole plug passes through
  RingNoWall,  ///< an open ring that no wall holds
};

Mesh between(double radius_m, double low_m, double high_m) {
  return transformed(makeCylinder(radius_m, high_m - low_m, 96),
                     Pose::translation({0, 0, 0.5 * (low_m + high_m)}));
}

Mesh openRing(double at_m, double toward_deg) {
  return ringPiece(3.1 * kMm, 9 * kMm, at_m, at_m + 2 * kMm, toward_deg + 80, toward_deg + 280);
}

/// The base "socket", and a plug whose shoulder is below the rings and whose head is above them:
///
///         |    | head |    |
///         |wall  |neck|    |     z = 9.05 to 14 mm: rings around the neck
///         |  ----------    |
///         +---| plug |-----+     z < 7 mm: a straight hole, or a bayonet
std::vector<DrawnPart> plugWith(Hold hold, Carried carried) {
  Mesh socket = bayonetSocket();
  if (hold == Hold::Straight) {
    socket = between(10 * kMm, -5.05 * kMm, -0.05 * kMm);
    append(socket, ringPiece(5.05 * kMm, 10 * kMm, -0.5 * kMm, 7 * kMm, 0, 360));
  }
  if (carried != Carried::RingNoWall)
    append(socket, ringPiece(9.2 * kMm, 12 * kMm, 6 * kMm, 16 * kMm, 0, 360));
  Mesh plug = hold == Hold::Bayonet ? ringPiece(4.5 * kMm, 7 * kMm, 2 * kMm, 4 * kMm, -15, 15) : Mesh();
  append(plug, between(5 * kMm, 0, 9 * kMm));
  append(plug, between(3 * kMm, 8 * kMm, 15 * kMm));
  append(plug, between((carried == Carried::WideRing ? 4.9 : 6.5) * kMm, 14 * kMm, 18 * kMm));
  std::vector<DrawnPart> parts = {at("socket", socket, {0, 0, 0}), at("plug", plug, {0, 0, 0})};
  const double low_m = 9.05 * kMm;
  switch (carried) {
    case Carried::Ring:
    case Carried::RingNoWall:
      parts.push_back(at("ring", openRing(low_m, 0), {0, 0, 0}));
      break;
    case Carried::TwoRings:
      parts.push_back(at("ring 1", openRing(low_m, 0), {0, 0, 0}));
      parts.push_back(at("ring 2", openRing(low_m + 2.05 * kMm, 180), {0, 0, 0}));
      break;
    case Carried::Halves:
      for (const double from_deg : {0.5, 180.5})
        parts.push_back(at(from_deg < 90 ? "half 1" : "half 2",
                           ringPiece(3.1 * kMm, 9 * kMm, low_m, low_m + 3 * kMm, from_deg, from_deg + 179),
                           {0, 0, 0}));
      break;
    case Carried::WideRing:
      parts.push_back(at("ring", ringPiece(5.2 * kMm, 9 * kMm, 7.05 * kMm, 9 * kMm, 0, 360), {0, 0, 0}));
      break;
  }
  return parts;
}

PlanResult planOnSocket(const std::vector<DrawnPart>& parts) {
  PlanSettings settings;
  settings.fixed = {"socket"};
  return planAssembly("test", parts, settings);
}

/// All parts leave the socket as one, and then the rings leave the plug one after the other.
void expectGroup(const std::vector<DrawnPart>& parts, WayKind kind, const std::string& what) {
  const PlanResult plan = planOnSocket(parts);
  EXPECT_EQ(plan.blocked(), 0U) << what;
  ASSERT_EQ(plan.assemblies.size(), 2U) << what;
  ASSERT_EQ(plan.assemblies[0].steps.size(), 1U) << what;
  const PlannedStep& step = plan.assemblies[0].steps.front();
  EXPECT_EQ(step.parts.size(), parts.size() - 1) << what;
  EXPECT_EQ(step.kind, kind) << what;
  EXPECT_EQ(plan.assemblies[1].steps.size(), parts.size() - 2) << what;
  for (const PlannedStep& inner : plan.assemblies[1].steps) EXPECT_EQ(inner.parts.size(), 1U) << what;
  if (kind != WayKind::Screw) expectFreeWays(parts, plan);
}

void expectNoGroup(const std::vector<DrawnPart>& parts, const std::string& what) {
  const PlanResult plan = planOnSocket(parts);
  EXPECT_EQ(plan.blocked(), 0U) << what;
  EXPECT_EQ(plan.assemblies.size(), 1U) << what;
  EXPECT_EQ(plan.steps(), parts.size() - 1) << what;
  expectFreeWays(parts, plan);
}

TEST(GroupWays, RingsLeaveStraightWithTheirPlug) {
  expectGroup(plugWith(Hold::Straight, Carried::Ring), WayKind::Straight, "ring");
  expectGroup(plugWith(Hold::Straight, Carried::TwoRings), WayKind::Straight, "two rings");
  expectGroup(plugWith(Hold::Straight, Carried::Halves), WayKind::Straight, "halves");
  std::vector<DrawnPart> tilted = plugWith(Hold::Straight, Carried::Ring);
  for (DrawnPart& part : tilted) part.X_WP = Pose(rotationFromVector({0.3, -0.5, 0.2}), Vec3(0.02, 0.01, 0));
  expectGroup(tilted, WayKind::Straight, "tilted");
}

TEST(GroupWays, ARingTurnsWithItsPlugOutOfABayonet) {
  expectGroup(plugWith(Hold::Bayonet, Carried::Ring), WayKind::Legs, "ring");
}
TEST(GroupWays, TwoRingsTurnWithTheirPlugOutOfABayonet) {
  expectGroup(plugWith(Hold::Bayonet, Carried::TwoRings), WayKind::Legs, "two rings");
}
TEST(GroupWays, HalvesOfARingTurnWithTheirPlugOutOfABayonet) {
  expectGroup(plugWith(Hold::Bayonet, Carried::Halves), WayKind::Legs, "halves");
}

TEST(GroupWays, RingsThatLeaveAloneAreNoGroup) {
  for (const Hold hold : {Hold::Straight, Hold::Bayonet}) {
    expectNoGroup(plugWith(hold, Carried::RingNoWall), "no wall");
    expectNoGroup(plugWith(hold, Carried::WideRing), "wide ring");
  }
}

/// A screw in a threaded base with a wall, and an open ring between its thread and its head.
std::vector<DrawnPart> screwWithRing() {
  test::ThreadShape thread;
  thread.columns = 48;
  thread.rows_per_pitch = 16;
  thread.length_m = 14 * kMm;
  test::ThreadShape nut = thread;
  nut.length_m = 8 * kMm;
  nut.clearance_m = 0.1 * kMm;
  Mesh base = test::makeNut(nut, 11 * kMm);
  append(base, ringPiece(9.2 * kMm, 12 * kMm, 2 * kMm, 14 * kMm, 0, 360));
  Mesh screw = transformed(test::makeThreadedRod(thread), Pose::translation({0, 0, -2 * thread.pitch_m}));
  append(screw, between(3 * kMm, 3 * kMm, 11 * kMm));
  append(screw, between(6.5 * kMm, 10 * kMm, 14 * kMm));
  return {at("socket", base, {0, 0, 0}), at("screw", screw, {0, 0, 0}),
          at("ring", openRing(4.05 * kMm, 0), {0, 0, 0})};
}

TEST(GroupWays, ARingIsScrewedOutWithItsScrew) {
  expectGroup(screwWithRing(), WayKind::Screw, "ring");
}

// A lid above the same group is part of the base, so that nothing leaves.
TEST(GroupWays, AGroupUnderALidIsNone) {
  std::vector<DrawnPart> parts = plugWith(Hold::Bayonet, Carried::Ring);
  const auto groupOf = [](const std::vector<DrawnPart>& drawn) {
    CheckSettings settings;
    settings.has_play = false;
    const std::vector<PlacedSurface> placed = placedSurfaces(drawn, {});
    const CheckResult checked = checkPlaced("test", placed, settings, {});
    const PairMotions motions(placed, checked, Vec3::UnitZ(), {});
    std::vector<SearchWork> work(drawn.size(), SearchWork{2'000'000, 0});
    return groupAlongLegs(motions, {0, 1, 2}, {0}, GroupSeeds::OnRoundFits, work, {}).parts;
  };
  EXPECT_EQ(groupOf(parts), (std::vector<std::size_t>{1, 2}));
  append(parts[0].mesh, ringPiece(0.5 * kMm, 12 * kMm, 18.5 * kMm, 20 * kMm, 0, 360));
  append(parts[0].mesh, ringPiece(9.2 * kMm, 12 * kMm, 15 * kMm, 19 * kMm, 0, 360));
  EXPECT_TRUE(groupOf(parts).empty());
}

}  // namespace
}  // namespace vps::scenes
