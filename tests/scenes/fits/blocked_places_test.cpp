// SPDX-License-Identifier: BSD-3-Clause
// The verdict Blocked is given only where it is proven. The assemblies of these tests can be put together by
// construction, although they overlap as drawn and a wrong proof would call them blocked; some others cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/units.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

CheckedPlaces placesOf(const std::vector<DrawnPart>& parts) {
  return checkAssembly("places", parts, {.has_play = false, .has_places = true}).places;
}

DrawnPart partAt(const std::string& name, const Mesh& mesh, const Vec3& p_W = Vec3::Zero(),
                 bool is_fixed = false) {
  DrawnPart out{name, mesh, Pose::translation(p_W), {}};
  out.is_fixed = is_fixed;
  return out;
}

Vec3 up(double z_m) {
  return {0, 0, z_m};
}

DrawnPart plate(bool is_fixed = true) {  // its top is at z = 4 mm
  return partAt("plate", makeBox({30 * kMm, 30 * kMm, 8 * kMm}), Vec3::Zero(), is_fixed);
}

using Profile = std::vector<std::pair<double, double>>;

/// The solid that an anticlockwise polygon of (radius, height) [mm] sweeps around z in some steps: all
/// around, or between two angles with flat ends.
Mesh swept(const Profile& profile_mm, int steps, double from_rad = 0, double by_rad = 2 * std::numbers::pi) {
  Mesh mesh;
  const bool is_whole = by_rad >= 2 * std::numbers::pi;
  const int rings = is_whole ? steps : steps + 1;
  const auto n = static_cast<std::uint32_t>(profile_mm.size());
  for (int i = 0; i < rings; ++i) {
    const double angle = from_rad + by_rad * i / steps;
    for (const auto& [r, z] : profile_mm)
      mesh.vertices.emplace_back(r * kMm * std::cos(angle), r * kMm * std::sin(angle), z * kMm);
  }
  const auto at = [&](int ring, std::uint32_t k) {
    return static_cast<std::uint32_t>(ring % rings) * n + k % n;
  };
  for (int i = 0; i < steps; ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  for (std::uint32_t k = 1; !is_whole && k + 1 < n; ++k) {  // of convex profiles
    mesh.triangles.push_back({at(0, 0), at(0, k), at(0, k + 1)});
    mesh.triangles.push_back({at(steps, 0), at(steps, k + 1), at(steps, k)});
  }
  return mesh;
}

// A pin with 20 um of clearance all around ends within its bore, and its flange is drawn 20 um into the
// plate: the pin can be lifted. The facets of pin and bore cross by more than 20 um at every place; this is
// their error and no overlap. The error of the flat flange is far less.
TEST(BlockedPlaces, TheErrorOfAFlatClashIsNotThatOfRoundFacesBesideIt) {
  for (const int segments : {16, 20, 24, 32})
    for (const bool is_fixed : {false, true}) {
      const Mesh pin = swept({{1, -4}, {5, -4}, {5, 0}, {8, 0}, {8, 3}, {1, 3}}, segments);
      const Mesh hub =
          swept({{5.02, -6}, {20, -6}, {20, 0}, {5.02, 0}}, segments, std::numbers::pi / segments);
      const CheckedPlaces places =
          placesOf({partAt("hub", hub, Vec3::Zero(), is_fixed), partAt("pin", pin, up(-20 * kUm))});
      EXPECT_NE(places.verdict, Verdict::Blocked) << segments << ": " << places.reason;
    }
}

TEST(BlockedPlaces, APressFitWithinALeverDoesNotTellWhereTheLeverIs) {
  const Mesh lever = makeTube(10 * kMm, 5 * kMm, 6 * kMm, 180);
  DrawnPart bushing = partAt("bushing", makeTube(5.005 * kMm, 3 * kMm, 6 * kMm, 180), up(7 * kMm - 60 * kUm));
  bushing.press_fit_m = 20 * kUm;
  const CheckedPlaces places = placesOf({plate(), partAt("lever", lever, up(7 * kMm - 60 * kUm)), bushing});
  ASSERT_EQ(places.verdict, Verdict::Fits) << places.reason;
  ASSERT_EQ(places.moved.size(), 2U);
  for (const MovedPart& moved : places.moved) EXPECT_NEAR(moved.by_W.z(), 60 * kUm, 1 * kUm);
}

TEST(BlockedPlaces, WhatMayOverlapTiesNothing) {
  const auto drawn = [](bool is_fixed) {
    DrawnPart seal = partAt("seal", makeTube(8 * kMm, 6 * kMm, 2 * kMm, 48), up(4 * kMm));
    seal.allow_overlap = true;
    return placesOf({plate(), seal,
                     partAt("lid", makeBox({20 * kMm, 20 * kMm, 6 * kMm}), up(7 * kMm - 2 * kUm), is_fixed)});
  };
  const CheckedPlaces loose = drawn(false);
  ASSERT_EQ(loose.verdict, Verdict::Fits) << loose.reason;
  ASSERT_EQ(loose.moved.size(), 1U);
  EXPECT_EQ(loose.moved.front().name, "lid");
  EXPECT_EQ(drawn(true).verdict, Verdict::Blocked);
}

TEST(BlockedPlaces, WhatIsPressedIntoAFixedPartIsNotFixedItself) {
  DrawnPart bushing = partAt("bushing", makeTube(5.005 * kMm, 3 * kMm, 6 * kMm, 180), up(-50 * kUm));
  bushing.press_fit_m = 20 * kUm;
  const CheckedPlaces places =
      placesOf({partAt("hub", makeTube(10 * kMm, 5 * kMm, 6 * kMm, 180), Vec3::Zero(), true), bushing,
                partAt("floor", makeBox({30 * kMm, 30 * kMm, 8 * kMm}), up(-7 * kMm), true)});
  EXPECT_EQ(places.verdict, Verdict::NotShown) << places.reason;
}

TEST(BlockedPlaces, APinThatIsDrawnTooDeepLeavesAlongItsOwnAxis) {
  const Mesh block = swept({{1, -5}, {15, -5}, {15, 10}, {5.005, 10}, {5.005, 0}, {1, 0}}, 180);
  const auto drawn = [&](double deep_m) {
    return placesOf({partAt("block", block, Vec3::Zero(), true),
                     partAt("dowel", makeCylinder(5 * kMm, 20 * kMm, 180), up(10 * kMm - deep_m))});
  };
  // The fit holds the pin to 30 um across its axis, and not at all along it.
  for (const double deep_m : {20 * kUm, 50 * kUm, 400 * kUm}) {
    const CheckedPlaces places = drawn(deep_m);
    ASSERT_EQ(places.verdict, Verdict::Fits) << deep_m << ": " << places.reason;
    ASSERT_EQ(places.moved.size(), 1U);
    EXPECT_NEAR(places.moved.front().by_W.z(), deep_m, 1 * kUm);
  }
  EXPECT_EQ(drawn(0.6 * kMm).verdict, Verdict::Blocked);
}

TEST(BlockedPlaces, APinInALooseLeverMovesWithIt) {
  const CheckedPlaces places =
      placesOf({plate(), partAt("lever", makeTube(10 * kMm, 5 * kMm + 2.5 * kUm, 6 * kMm, 180), up(12 * kMm)),
                partAt("pin", makeCylinder(5 * kMm, 14 * kMm, 180), up(11 * kMm - 100 * kUm))});
  EXPECT_NE(places.verdict, Verdict::Blocked) << places.reason;
}

// The shaft's radius is 5 um larger than that of two cradles. Together they surround the shaft, but at
// different places along it, so the shaft can stand in them at a slant.
TEST(BlockedPlaces, CradlesAtTwoPlacesAlongAShaftDoNotSurroundIt) {
  Mesh bracket = swept({{5, 0}, {8, 0}, {8, 5}, {5, 5}}, 130, -65 * kDegree, 130 * kDegree);
  append(bracket, swept({{5, 25}, {8, 25}, {8, 30}, {5, 30}}, 130, 115 * kDegree, 130 * kDegree));
  const CheckedPlaces places = placesOf(
      {partAt("bracket", bracket), partAt("shaft", makeCylinder(5.005 * kMm, 34 * kMm, 720), up(15 * kMm))});
  EXPECT_EQ(places.verdict, Verdict::Fits) << places.reason;
}

// A plane cuts the bore in an ellipse whose lesser axis is the bore's diameter: a disc that is larger fits
// into no such ellipse, however thin it is.
TEST(BlockedPlaces, ADiscLargerThanABoreDoesNotStandInItAtASlantEither) {
  const auto drawn = [](double thick_m) {
    return placesOf({partAt("hub", makeTube(10 * kMm, 5 * kMm, 12 * kMm, 720), Vec3::Zero(), true),
                     partAt("disc", makeCylinder(5.01 * kMm, thick_m, 720))});
  };
  for (const double thick_m : {0.1 * kMm, 4 * kMm})
    EXPECT_EQ(drawn(thick_m).verdict, Verdict::Blocked) << thick_m;
}

// A shaft with a flat on one side, or with a hole near its face, gives no proof; a hub with a slit gives one.
TEST(BlockedPlaces, AShaftMustBeRoundAndFullToBeTooLarge) {
  const Mesh slit_hub = swept({{5, -6}, {10, -6}, {10, 6}, {5, 6}}, 300, 10 * kDegree, 340 * kDegree);
  const Mesh shaft = makeCylinder(5.01 * kMm, 20 * kMm, 720);
  EXPECT_EQ(placesOf({partAt("hub", slit_hub), partAt("shaft", shaft)}).verdict, Verdict::Blocked);
  const Mesh slit_shaft =
      swept({{2, -10}, {5.01, -10}, {5.01, 10}, {2, 10}}, 300, 10 * kDegree, 340 * kDegree);
  const Mesh hub = makeTube(10 * kMm, 5 * kMm, 12 * kMm, 720);
  EXPECT_NE(placesOf({partAt("hub", hub), partAt("shaft", slit_shaft)}).verdict, Verdict::Fits);
  const Mesh sleeve = makeTube(5.01 * kMm, 4.5 * kMm, 20 * kMm, 720);  // a thin wall alone proves nothing
  EXPECT_EQ(placesOf({partAt("hub", hub), partAt("shaft", sleeve)}).verdict, Verdict::NotShown);
}

TEST(BlockedPlaces, ABlockMuchWiderThanAFixedSlotIsBlocked) {
  // The overlap is 0.4 mm in each of two walls; no place within 0.5 mm changes the mean of both.
  const Mesh wall = makeBox({8 * kMm, 30 * kMm, 20 * kMm});
  const CheckedPlaces places =
      placesOf({partAt("left", wall, {-9 * kMm, 0, 0}, true), partAt("right", wall, {9 * kMm, 0, 0}, true),
                partAt("block", makeBox({10.8 * kMm, 14 * kMm, 8 * kMm}))});
  EXPECT_EQ(places.verdict, Verdict::Blocked);
  EXPECT_NE(places.reason.find("within 500.0 um of where they are drawn"), std::string::npos)
      << places.reason;
}

TEST(BlockedPlaces, OfASurfaceWithAHoleNothingIsProven) {
  Mesh open = makeBox({6 * kMm, 6 * kMm, 6 * kMm});
  const auto drawn = [&](double deep_m) {
    return placesOf({plate(), partAt("block", open, up(7 * kMm - deep_m))});
  };
  EXPECT_EQ(drawn(2 * kMm).verdict, Verdict::Blocked);
  open.triangles.pop_back();
  EXPECT_EQ(drawn(2 * kMm).verdict, Verdict::NotShown);
}

TEST(BlockedPlaces, TwoThatAreEachLessDeepThanBothMayMoveShareTheWay) {
  const Mesh box = makeBox({10 * kMm, 10 * kMm, 10 * kMm});
  const CheckedPlaces places = placesOf({partAt("a", box), partAt("b", box, up(10 * kMm - 0.7 * kMm))});
  ASSERT_EQ(places.verdict, Verdict::Fits) << places.reason;
  EXPECT_EQ(places.moved.size(), 2U);
  EXPECT_EQ(placesOf({partAt("a", box), partAt("b", box, up(10 * kMm - 1.1 * kMm))}).verdict,
            Verdict::Blocked);
}

// An open sheet as drawn may or may not overlap the ring around it. The verdict of the whole assembly reports
// this doubt; the places of the other parts are found.
TEST(BlockedPlaces, PairsThatCannotBeToldAsDrawnDoNotHidePlaces) {
  Mesh sheet;
  sheet.vertices = {
      {5 * kMm, 0, 5 * kMm}, {7 * kMm, 0, 5 * kMm}, {7 * kMm, 0, 9 * kMm}, {5 * kMm, 0, 9 * kMm}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const CheckResult found = checkAssembly(
      "places",
      {plate(), partAt("ring", makeTube(10 * kMm, 8 * kMm, 6 * kMm, 48), up(7 * kMm)), partAt("sheet", sheet),
       partAt("block", makeBox({6 * kMm, 6 * kMm, 6 * kMm}), up(6.9 * kMm))},
      {.has_play = false, .has_places = true});
  EXPECT_EQ(found.uncertain(), 1U);
  EXPECT_EQ(found.places.verdict, Verdict::Fits) << found.places.reason;
  EXPECT_EQ(found.places.moved.size(), 1U);
  EXPECT_EQ(found.verdict(), Verdict::NotShown);
}

}  // namespace
}  // namespace vps::scenes
