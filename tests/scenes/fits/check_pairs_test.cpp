// SPDX-License-Identifier: BSD-3-Clause
// Overlap and clearance of parts whose geometry is known by construction.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "scenes/drawn_part.h"
#include "support/faulty_meshes.h"
#include "vps/errors.h"
#include "vps/mesh_overlap.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

const CheckSettings kPairsOnly{.has_fits = false, .has_play = false};

CheckResult check(const std::vector<DrawnPart>& parts) {
  return checkAssembly("test", parts, kPairsOnly);
}
DrawnPart block(const std::string& name, const Vec3& size_m, const Pose& X_WP) {
  return part(name, makeBox(size_m), X_WP);
}
Pose at(double x, double y, double z) {
  return Pose::translation(Vec3(x, y, z));
}

TEST(CheckPairs, AGapThatEveryReportWritesAsZeroIsContact) {
  for (const auto& [gap_m, state] :
       {std::pair{4e-9, PairState::Contact}, std::pair{6e-9, PairState::Apart}}) {
    const CheckResult result = check({block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)),
                                      block("block", {0.01, 0.02, 0.03}, at(0.02, 0.01, 0.015 + gap_m))});
    ASSERT_EQ(result.pairs.size(), 1U) << gap_m;
    EXPECT_EQ(result.pairs[0].state, state) << gap_m;
  }
}

TEST(CheckPairs, ABlockAboveAPlateHasItsGapAsClearance) {
  for (const double gap_m : {1e-6, 20e-6, 0.9e-3}) {
    const CheckResult result = check({block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)),
                                      block("block", {0.01, 0.02, 0.03}, at(0.02, 0.01, 0.015 + gap_m))});
    ASSERT_EQ(result.pairs.size(), 1U) << gap_m;
    const CheckedPair& pair = result.pairs[0];
    EXPECT_EQ(pair.state, PairState::Apart);
    EXPECT_NEAR(pair.clearance_m, gap_m, pair.error_m);
    EXPECT_LT(pair.error_m, 1e-12);  // flat faces: only rounding
    EXPECT_NEAR(pair.at_W.z(), gap_m / 2, 1e-12);
    EXPECT_EQ(result.clashes(), 0U);
  }
}

TEST(CheckPairs, PartsFartherApartThanNearAreLeftOut) {
  EXPECT_TRUE(check({block("a", {0.1, 0.1, 0.1}, at(0, 0, 0)), block("b", {0.1, 0.1, 0.1}, at(0, 0, 0.1011))})
                  .pairs.empty());
}

TEST(CheckPairs, ABlockInAPlateHasDepthVolumeAndPlace) {
  for (const double depth_m : {0.7e-6, 5e-6, 90e-6, 1e-3}) {
    const CheckResult result = check({block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)),
                                      block("block", {0.01, 0.02, 0.03}, at(0.02, 0.01, 0.015 - depth_m))});
    ASSERT_EQ(result.pairs.size(), 1U);
    const CheckedPair& pair = result.pairs[0];
    EXPECT_EQ(pair.state, PairState::Clash) << depth_m;
    EXPECT_NEAR(pair.interference_depth_m, depth_m, pair.error_m);
    EXPECT_LE(pair.error_m, 0.1001e-6);  // kOverlapCertain_m and rounding
    EXPECT_NEAR(pair.interference_volume_m3, 0.01 * 0.02 * depth_m, pair.volume_error_m3);
    EXPECT_LT(pair.volume_error_m3, 0.05e-9);  // 4.4 cm2 of surface by 0.1 um
    EXPECT_NEAR(pair.at_W.z(), -depth_m, pair.error_m);
    EXPECT_EQ(pair.clearance_m, 0);
    EXPECT_EQ(result.clashes(), 1U);
  }
}

// Depths of a run have a precision of 0.5 um; the check's search may be off by 0.1 um.
TEST(CheckPairs, AnOverlapIsAClashFromHalfAMicrometreBeyondItsErrorOn) {
  for (const auto& [depth_m, state] : {std::pair{0.15e-6, PairState::Contact},
                                       {0.3e-6, PairState::Contact},
                                       {0.59e-6, PairState::Contact},
                                       {0.61e-6, PairState::Clash},
                                       {1e-6, PairState::Clash}}) {
    const CheckResult result = check({block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)),
                                      block("block", {0.01, 0.02, 0.03}, at(0.02, 0.01, 0.015 - depth_m))});
    ASSERT_EQ(result.pairs.size(), 1U);
    EXPECT_EQ(result.pairs[0].state, state) << depth_m;
    EXPECT_NEAR(result.pairs[0].interference_depth_m, depth_m, result.pairs[0].error_m);
    EXPECT_NEAR(result.pairs[0].error_m, kOverlapCertain_m, 1e-12);
  }
}

TEST(CheckPairs, AnOverlapThatTheSceneAllowsIsReportedAndIsNoClash) {
  DrawnPart pin = block("pin", {0.01, 0.02, 0.03}, at(0, 0, 0.0149));
  pin.allow_overlap = true;
  const CheckResult result = check({block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)), pin});
  ASSERT_EQ(result.pairs.size(), 1U);
  EXPECT_EQ(result.pairs[0].state, PairState::Clash);
  EXPECT_EQ(result.clashes(), 0U);
}

TEST(CheckPairs, CoincidentFacesAreContact) {
  const CheckResult stacked =
      check({block("a", {0.04, 0.03, 0.02}, at(0, 0, 0)), block("b", {0.04, 0.03, 0.02}, at(0, 0, 0.02)),
             block("c", {0.01, 0.01, 0.01}, at(0.025, 0, 0.01))});
  ASSERT_EQ(stacked.pairs.size(), 3U);
  for (const CheckedPair& pair : stacked.pairs) {
    EXPECT_EQ(pair.state, PairState::Contact) << pair.a << pair.b;
    EXPECT_LT(pair.clearance_m, 1e-15);
    EXPECT_EQ(pair.interference_depth_m, 0);
  }
}

// Facets of the pin cross facets of the bore, since both approximate one cylinder.
TEST(CheckPairs, APinAsLargeAsItsBoreIsContactWhateverTheFacets) {
  const Mesh bore = makeTube(0.02, 0.01, 0.03, 180);
  for (const int segments : {90, 180, 203}) {
    const CheckResult result =
        check({part("bore", bore), part("pin", makeCylinder(0.01, 0.05, segments),
                                        Pose(rotationFromVector(Vec3(0, 0, 0.01)), Vec3::Zero()))});
    ASSERT_EQ(result.pairs.size(), 1U);
    EXPECT_EQ(result.pairs[0].state, PairState::Contact) << segments;
  }
}

TEST(CheckPairs, APinIsAClashFromTheErrorOn) {
  const double bore_m = 0.01, chord_m = bore_m * (1 - std::cos(std::numbers::pi / 1440));  // 0.02 um
  const Mesh bore = makeTube(0.02, bore_m, 0.03, 1440);
  for (const double clearance_m : {-2e-6, -1e-6, 1e-6, 2e-6}) {
    const CheckResult result =
        check({part("bore", bore), part("pin", makeCylinder(bore_m - clearance_m, 0.05, 1440))});
    ASSERT_EQ(result.pairs.size(), 1U);
    const CheckedPair& pair = result.pairs[0];
    EXPECT_EQ(pair.state, clearance_m < 0 ? PairState::Clash : PairState::Apart) << clearance_m;
    EXPECT_NEAR(clearance_m < 0 ? -pair.interference_depth_m : pair.clearance_m, clearance_m, pair.error_m);
    EXPECT_LT(pair.error_m, 4 * chord_m + 0.11e-6);
  }
}

// Sixteen facets have a chord error of 96 um in the radius. The base of the disc and the plate are flat and
// have no chord error.
TEST(CheckPairs, AFlatFaceInAFlatFaceIsAClashHoweverCoarseTheRoundFacesBesideThem) {
  const Pose X_WP(rotationFromVector(Vec3(0.4, -1.1, 0.3)), Vec3(0.2, -0.1, 0.3));
  for (const int segments : {16, 24, 60, 200})
    for (const double depth_m : {1e-6, 5e-6, 20e-6, 80e-6}) {
      const CheckResult result =
          check({part("plate", makeBox({0.04, 0.04, 0.02}), X_WP * at(0, 0, -0.01)),
                 part("disc", makeCylinder(5e-3, 0.01, segments), X_WP * at(0, 0, 0.005 - depth_m))});
      ASSERT_EQ(result.pairs.size(), 1U);
      const CheckedPair& pair = result.pairs[0];
      EXPECT_EQ(pair.state, PairState::Clash) << segments << " facets, " << depth_m;
      EXPECT_NEAR(pair.interference_depth_m, depth_m, pair.error_m);
      EXPECT_LT(pair.error_m, 0.11e-6);  // kOverlapCertain_m and rounding
    }
}

// The depth is proportional to the cosine of the lean; only the sine of the lean times the round face's chord
// error enters its error.
TEST(CheckPairs, TheRimOfALeaningDiscIsCertainToWithinTheChordTimesTheSineOfTheLean) {
  const double lean_rad = 2e-3, depth_m = 20e-6, radius_m = 5e-3;
  const double chord_m = radius_m * (1 - std::cos(std::numbers::pi / 16));
  const Pose X_WP(rotationFromVector(Vec3(lean_rad, 0, 0)),
                  Vec3(0, 0, 0.005 + radius_m * lean_rad - depth_m));
  const CheckResult result = check({block("plate", {0.04, 0.04, 0.02}, at(0, 0, -0.01)),
                                    part("disc", makeCylinder(radius_m, 0.01, 16), X_WP)});
  ASSERT_EQ(result.pairs.size(), 1U);
  const CheckedPair& pair = result.pairs[0];
  EXPECT_EQ(pair.state, PairState::Clash);
  EXPECT_GT(pair.error_m, 0.5 * std::sin(lean_rad) * chord_m);
  EXPECT_LT(pair.error_m, 5 * std::sin(lean_rad) * chord_m + 0.11e-6);
}

TEST(CheckPairs, RoundFacesThatCrossWithinTheirChordsAreNoClash) {
  for (const int segments : {20, 32, 60})
    for (const double turn : {0.0, 0.25, 0.5}) {
      const Mesh bore = makeTube(0.02, 8.05e-3, 0.01, segments);
      const Pose turned(rotationFromVector(Vec3(0, 0, turn * 2 * std::numbers::pi / segments)), Vec3::Zero());
      const CheckResult result =
          check({part("bore", bore), part("pin", makeCylinder(8e-3, 0.03, segments), turned)});
      ASSERT_EQ(result.pairs.size(), 1U);
      EXPECT_NE(result.pairs[0].state, PairState::Clash) << segments << " facets, turned by " << turn;
    }
}

TEST(CheckPairs, BallsHaveTheirGapAndTheVolumeOfTheirLensWithinTheError) {
  const double r = 0.01;
  const Mesh ball = makeSphere(r, 4);
  for (const double gap_m : {0.3e-3, -0.1e-3, -2e-3}) {
    const CheckResult result =
        check({part("a", ball),
               part("b", ball,
                    Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.6, 0.8, 0) * (2 * r + gap_m)))});
    ASSERT_EQ(result.pairs.size(), 1U);
    const CheckedPair& pair = result.pairs[0];
    if (gap_m > 0) {
      EXPECT_NEAR(pair.clearance_m, gap_m, pair.error_m);
    } else {
      const double h = -gap_m / 2;  // height of each cap
      EXPECT_EQ(pair.state, PairState::Clash);
      EXPECT_NEAR(pair.interference_volume_m3, 2 * std::numbers::pi * h * h * (r - h / 3),
                  pair.volume_error_m3);
    }
    EXPECT_LT(pair.error_m, 60e-6);  // facets of 0.8 mm are up to 13 um inside each ball
  }
}

TEST(CheckPairs, ATurnedBlockInABlockSharesAnOctagon) {
  const Pose turned(rotationFromVector(Vec3(0, 0, std::numbers::pi / 4)), Vec3(0, 0, 0.005));
  const CheckResult result =
      check({block("a", {0.02, 0.02, 0.02}, Pose()), block("b", {0.02, 0.02, 0.02}, turned)});
  ASSERT_EQ(result.pairs.size(), 1U);
  const double octagon_m2 = 2 * (std::sqrt(2.0) - 1) * 0.02 * 0.02;
  EXPECT_NEAR(result.pairs[0].interference_volume_m3, octagon_m2 * 0.015, result.pairs[0].volume_error_m3);
  EXPECT_LT(result.pairs[0].volume_error_m3, 1e-9);  // 17 cm2 by 0.1 um would be 0.17 mm3
}

// Each bar's edges are 2 mm inside the other bar's faces, and the shared volume is 6 mm thick.
TEST(CheckPairs, BarsThatCrossAreAsDeepAsWhatTheyShareIsThick) {
  const CheckResult result = check(
      {block("along", {0.1, 0.01, 0.01}, at(0, 0, 0)), block("across", {0.006, 0.1, 0.006}, at(0, 0, 0))});
  ASSERT_EQ(result.pairs.size(), 1U);
  EXPECT_NEAR(result.pairs[0].interference_depth_m, 6e-3, 1e-6);
  EXPECT_NEAR(result.pairs[0].interference_volume_m3, 6e-3 * 6e-3 * 10e-3, result.pairs[0].volume_error_m3);
}

// A block stands on the floor of a trough with a gap of 20 um on each side, and all facets are torn apart.
// Each corner is moved by up to jitter_m along each axis, so cracks have widths of up to 2 sqrt(3) jitter_m.
// A point of the block's lower edges, at a crack of the floor, must not count as deep as its distance from
// the walls.
TEST(CheckPairs, FacetsThatAreTornApartAreNoClashAndTheirCracksAreInTheError) {
  const Mesh trough = test::faulty::bracket(), block = makeBox({8e-3 - 40e-6, 6e-3, 8e-3});
  for (const double jitter_m : {0.2e-6, 1e-6, 5e-6, 25e-6})
    for (const double depth_m : {0.0, 30e-6, 0.4e-3}) {
      const Pose X_WP = test::faulty::pose() * at(0, 1e-3 - depth_m, 0);
      const CheckResult result = check({part("trough", test::faulty::unwelded(trough, jitter_m)),
                                        part("block", test::faulty::unwelded(block, jitter_m), X_WP)});
      ASSERT_EQ(result.pairs.size(), 1U);
      const CheckedPair& pair = result.pairs[0];
      // The sum of the cracks of two parts, half of the closed cracks, and the precision of a depth.
      EXPECT_LE(pair.error_m, 2 * 2 * std::sqrt(3.0) * jitter_m + 2e-6 + 0.11e-6) << jitter_m;
      EXPECT_NEAR(pair.interference_depth_m, depth_m, pair.error_m) << jitter_m;
      if (depth_m == 0) {
        EXPECT_EQ(pair.state, PairState::Contact) << jitter_m;
      }
      if (depth_m > 0.1e-3) {
        EXPECT_EQ(pair.state, PairState::Clash) << jitter_m;
      }
    }
}

TEST(CheckPairs, AnAssemblyWithASurfaceThatHasNoInsideGetsNoVerdict) {
  Mesh sheet{{Vec3(-0.02, -0.02, 0), Vec3(0.02, -0.02, 0), Vec3(0.02, 0.02, 0), Vec3(-0.02, 0.02, 0)},
             {{0, 1, 2}, {0, 2, 3}}};
  const DrawnPart cube = block("cube", {0.01, 0.01, 0.01}, at(0, 0, 0));
  for (const Mesh& thin : {sheet, makeBox(Vec3(0.04, 0.04, 0.1e-6))}) {
    const CheckResult result = check({cube, part("sheet", thin)});
    ASSERT_EQ(result.pairs.size(), 1U);
    EXPECT_TRUE(result.pairs[0].is_uncertain);
    EXPECT_EQ(result.clashes(), 0U);
    EXPECT_EQ(result.uncertain(), 1U);
    EXPECT_FALSE(result.parts[1].no_inside.empty());
    EXPECT_TRUE(result.parts[0].no_inside.empty());
    // Away from the part nothing is uncertain.
    const CheckResult beside = check({cube, part("sheet", thin, at(0, 0, 5.1e-3))});
    EXPECT_EQ(beside.uncertain(), 0U);
    EXPECT_EQ(beside.pairs.at(0).state, PairState::Apart);
  }
}

// Two of three facets of a ball are missing, so it is undefined which points are inside.
TEST(CheckPairs, ASurfaceTornToPiecesGetsNoVerdict) {
  Mesh torn = makeSphere(0.02, 2);
  Mesh pieces;
  for (std::size_t i = 0; i < torn.triangles.size(); i += 3)
    for (const std::uint32_t v : torn.triangles[i]) {
      if (pieces.vertices.size() % 3 == 0) {
        const auto n = static_cast<std::uint32_t>(pieces.vertices.size());
        pieces.triangles.push_back({n, n + 1, n + 2});
      }
      pieces.vertices.push_back(torn.vertices[v]);
    }
  const CheckResult result = check({part("torn", pieces), block("cube", {0.01, 0.01, 0.01}, at(0, 0, 0))});
  EXPECT_EQ(result.clashes(), 0U);
  EXPECT_EQ(result.uncertain(), 1U);
  EXPECT_FALSE(result.parts[0].no_inside.empty()) << result.parts[0].mesh_faults;
}

TEST(CheckPairs, APartDrawnTwiceIsAClashOfItsWholeVolume) {
  const Mesh tube = makeTube(0.02, 0.01, 0.03, 64);
  const CheckResult result = check({part("tube", tube, at(0.1, 0, 0)), part("tube_2", tube, at(0.1, 0, 0))});
  ASSERT_EQ(result.pairs.size(), 1U);
  const CheckedPair& pair = result.pairs[0];
  EXPECT_EQ(pair.state, PairState::Clash);
  EXPECT_GT(pair.interference_depth_m, 0.003);  // the wall is 10 mm thick
  EXPECT_NEAR(pair.interference_volume_m3, massProperties(tube).volume_m3, pair.volume_error_m3);
}

TEST(CheckPairs, MovingTheAssemblyMovesOnlyThePlaces) {
  const Pose X(rotationFromVector(Vec3(0.4, -0.7, 0.2)), Vec3(0.3, -0.2, 0.5));
  const std::vector<DrawnPart> still = {block("plate", {0.1, 0.1, 0.02}, at(0, 0, -0.01)),
                                        block("block", {0.01, 0.02, 0.03}, at(0.02, 0.01, 0.015 - 50e-6))};
  std::vector<DrawnPart> turned = still;
  for (DrawnPart& drawn : turned) drawn.X_WP = X * drawn.X_WP;
  const CheckedPair a = check(still).pairs.at(0), b = check(turned).pairs.at(0);
  EXPECT_NEAR(a.interference_depth_m, b.interference_depth_m, a.error_m);
  EXPECT_NEAR(a.interference_volume_m3, b.interference_volume_m3, a.volume_error_m3);
  EXPECT_NEAR((X.inverse() * b.at_W).z(), a.at_W.z(), a.error_m);
}

TEST(CheckPairs, AnyNumberOfThreadsGivesTheSameBits) {
  std::vector<DrawnPart> parts;
  for (int i = 0; i < 12; ++i)
    parts.push_back(
        part("ball", makeSphere(0.01, 2),
             Pose(rotationFromVector(Vec3(i, 0.3 * i, 0)), Vec3(0.018 * (i % 4), 0.0201 * (i / 4), 0))));
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return check(parts);
  };
  const CheckResult one = run(1), four = run(4);
  ASSERT_EQ(one.pairs.size(), four.pairs.size());
  ASSERT_GT(one.pairs.size(), 10U);
  for (std::size_t i = 0; i < one.pairs.size(); ++i) {
    EXPECT_EQ(one.pairs[i].clearance_m, four.pairs[i].clearance_m);
    EXPECT_EQ(one.pairs[i].interference_depth_m, four.pairs[i].interference_depth_m);
    EXPECT_EQ(one.pairs[i].interference_volume_m3, four.pairs[i].interference_volume_m3);
    EXPECT_EQ(one.pairs[i].at_W, four.pairs[i].at_W);
  }
}

TEST(CheckPairs, SizesThatCannotBeMeasuredAreRefused) {
  for (const double size_m : {1e-9, 1e4}) {
    try {
      check({part("speck", makeBox(Vec3::Constant(size_m)))});
      ADD_FAILURE() << size_m;
    } catch (const LoadError& error) {
      EXPECT_NE(std::string(error.what()).find("Is the unit right?"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace vps::scenes
