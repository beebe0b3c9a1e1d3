// SPDX-License-Identifier: BSD-3-Clause
// Overlaps that drawings have on purpose, made by a generator whose answers are known: threads drawn as
// cylinders, O-rings, threads out of phase, inserts. No clash may be hidden.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "fits/iso_sizes.h"
#include "support/lathe.h"
#include "support/screw.h"
#include "vps_scenes/fits/check.h"

namespace vps::scenes {
namespace {

DrawnPart knownDrawn(const std::string& name, const Mesh& mesh, const Vec3& p_m = Vec3::Zero()) {
  return {name, mesh, Pose::translation(p_m), {}, false};
}

CheckedPair knownPair(const std::vector<DrawnPart>& parts, const OverlapWishes& overlaps = {}) {
  const CheckResult result =
      checkAssembly("test", parts, {.has_fits = false, .has_play = false, .overlaps = overlaps});
  EXPECT_EQ(result.pairs.size(), 1U);
  EXPECT_EQ(result.clashes(), result.pairs.at(0).state == PairState::Clash ? 1U : 0U);
  return result.pairs.at(0);
}

/// A size of ISO 262 with its coarse pitch and the hole of its drill [mm].
struct CoarseSize {
  const char* name;
  double d, pitch, drill;
  [[nodiscard]] double minor() const { return d - 1.0825 * pitch; }
};
constexpr std::array kCoarse{CoarseSize{"M3", 3, 0.5, 2.5},    CoarseSize{"M4", 4, 0.7, 3.3},
                             CoarseSize{"M5", 5, 0.8, 4.2},    CoarseSize{"M6", 6, 1, 5},
                             CoarseSize{"M8", 8, 1.25, 6.8},   CoarseSize{"M10", 10, 1.5, 8.5},
                             CoarseSize{"M12", 12, 1.75, 10.2}};

constexpr int kSides = 32;

/// A screw with a round head; its shank points downwards from z = 0.
DrawnPart drawnScrew(double d_mm, const Vec3& p_m = Vec3::Zero()) {
  const double r = 0.5e-3 * d_mm;
  return knownDrawn(
      "screw",
      test::lathe({{0, -5 * r}, {r, -5 * r}, {r, 0}, {1.6 * r, 0}, {1.6 * r, 1.2 * r}, {0, 1.2 * r}}, kSides),
      p_m);
}
/// A round plate with its top at z = 0.
DrawnPart drawnPlate(double d_mm, double hole_mm) {
  const double r = 0.5e-3 * d_mm;
  return knownDrawn("plate", makeTube(8 * r, 0.5e-3 * hole_mm, 3 * r, kSides), {0, 0, -1.5 * r});
}

TEST(KnownOverlaps, AScrewInTheHoleOfItsThreadIsAThreadOfItsSize) {
  for (const CoarseSize& size : kCoarse)
    for (const double hole_mm : {size.minor(), size.drill}) {
      const CheckedPair pair = knownPair({drawnPlate(size.d, hole_mm), drawnScrew(size.d)});
      EXPECT_EQ(pair.state, PairState::Thread) << size.name << " in " << hole_mm << ": " << pair.explanation;
      EXPECT_EQ(pair.nominal, size.name);
      EXPECT_EQ(pair.fastener, "screw");
      EXPECT_NE(pair.explanation.find(size.name), std::string::npos) << pair.explanation;
    }
}

TEST(KnownOverlaps, AScrewOfTheNextSizeIsAClash) {
  for (std::size_t i = 1; i < kCoarse.size(); ++i) {
    const CheckedPair pair =
        knownPair({drawnPlate(kCoarse[i].d, kCoarse[i - 1].minor()), drawnScrew(kCoarse[i].d)});
    EXPECT_EQ(pair.state, PairState::Clash) << kCoarse[i].name << ": " << pair.explanation;
  }
}

TEST(KnownOverlaps, AnEccentricScrewIsAClash) {
  for (const CoarseSize& size : kCoarse)
    EXPECT_EQ(knownPair({drawnPlate(size.d, size.minor()), drawnScrew(size.d, {0.3e-3, 0, 0})}).state,
              PairState::Clash)
        << size.name;
}

// The overlap of the head is a tenth as deep as that of the thread, so the depth alone would not show it.
TEST(KnownOverlaps, AThreadDoesNotHideAHeadThatIsSunkIntoThePlate) {
  for (const CoarseSize& size : {kCoarse[1], kCoarse[4], kCoarse[6]}) {
    const CheckedPair pair =
        knownPair({drawnPlate(size.d, size.minor()), drawnScrew(size.d, {0, 0, -50e-6})});
    EXPECT_EQ(pair.state, PairState::Clash) << size.name;
    EXPECT_NE(pair.explanation.find("elsewhere"), std::string::npos) << pair.explanation;
  }
}

// A plain cylinder may be a stud, or a pin in the wrong hole.
TEST(KnownOverlaps, APlainPinInAPlateIsAThreadOnlyIfItIsDeclared) {
  const std::vector<DrawnPart> parts = {drawnPlate(8, 6.647),
                                        knownDrawn("stud", makeCylinder(4e-3, 30e-3, kSides))};
  const CheckedPair pair = knownPair(parts);
  EXPECT_EQ(pair.state, PairState::Clash);
  EXPECT_NE(pair.explanation.find("a file of rules can declare a thread"), std::string::npos)
      << pair.explanation;
  const OverlapRule declared{{"stud", "plate", "here"}, OverlapWish::Thread, {}};
  EXPECT_EQ(knownPair(parts, {.rules = {declared}}).state, PairState::Thread);
}

TEST(KnownOverlaps, ANutIsAThread) {
  const Mesh nut = test::sweptSections(48, [&](int i) {
    const double angle = test::kTurn_rad * (i % 48) / 48, out_m = test::polygonRadius(7.5e-3, 6, angle);
    return std::vector<Vec3>{test::polar(3.324e-3, angle, -3e-3), test::polar(out_m, angle, -3e-3),
                             test::polar(out_m, angle, 3e-3), test::polar(3.324e-3, angle, 3e-3)};
  });
  EXPECT_EQ(knownPair({knownDrawn("nut", nut, {0, 0, -10e-3}), drawnScrew(8)}).nominal, "M8");
}

TEST(KnownOverlaps, StrictAndARuleRefuseWhatTheShapesSuggest) {
  const std::vector<DrawnPart> parts = {drawnPlate(8, 6.647), drawnScrew(8)};
  EXPECT_EQ(knownPair(parts, {.is_strict = true}).state, PairState::Clash);
  const OverlapRule refused{{"screw", "plate", "here"}, OverlapWish::Clash, {}},
      declared{{"screw", "plate", "here"}, OverlapWish::Thread, {}};
  EXPECT_EQ(knownPair(parts, {.rules = {refused}}).state, PairState::Clash);
  EXPECT_EQ(knownPair(parts, {.rules = {declared}, .is_strict = true}).state, PairState::Thread);
  // A quarter inch is no size of ISO 262: a thread where it is declared, else a clash.
  const std::vector<DrawnPart> inch = {drawnPlate(6.35, 5.2), drawnScrew(6.35)};
  EXPECT_EQ(knownPair(inch).state, PairState::Clash);
  EXPECT_EQ(knownPair(inch, {.rules = {declared}}).state, PairState::Thread);
}

/// A bore in which an O-ring is squashed, and the O-ring; radii in metres.
std::vector<DrawnPart> boredSeal(double section_m, double squash, double aside_m = 0) {
  const double ring_m = 8 * section_m;
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * std::numbers::pi * i / 24;
    profile.push_back({ring_m + section_m * std::cos(a), section_m * std::sin(a)});
  }
  const double bore_m = ring_m + section_m * (1 - 2 * squash);
  return {knownDrawn("seal", test::lathe(profile, 72)),
          knownDrawn("bore", makeTube(2 * ring_m, bore_m, 4 * section_m, 72), {aside_m, 0, 0})};
}

TEST(KnownOverlaps, AnORingIsASealUpToItsGreatestSquash) {
  for (const double section_m : {0.89e-3, 1.3e-3, 2.65e-3})
    for (const double squash : {0.05, 0.15, 0.28, 0.33, 0.40}) {
      const CheckedPair pair = knownPair(boredSeal(section_m, squash));
      EXPECT_EQ(pair.state, squash < 0.30 ? PairState::Seal : PairState::Clash)
          << section_m << " by " << squash << ": " << pair.explanation;
      // The bore's facets are inside its cylinder by 0.1 % of the ring's radius, which is 0.4 % of the
      // section.
      EXPECT_NEAR(pair.squash, squash, 0.006);
      EXPECT_NE(pair.explanation.find("O-ring"), std::string::npos) << pair.explanation;
    }
}

TEST(KnownOverlaps, AnORingThatABoreTouchesOnOneSideIsAClash) {
  EXPECT_EQ(knownPair(boredSeal(0.89e-3, 0.15, 0.3e-3)).state, PairState::Clash);
}

TEST(KnownOverlaps, ARuleSetsTheGreatestSquash) {
  const auto ruled = [](double most) {
    return OverlapWishes{.rules = {{{"seal", "bore", "here"}, OverlapWish::Seal, most}}};
  };
  EXPECT_EQ(knownPair(boredSeal(0.89e-3, 0.15), ruled(0.1)).state, PairState::Clash);
  EXPECT_EQ(knownPair(boredSeal(0.89e-3, 0.40), ruled(0.45)).state, PairState::Seal);
}

test::ThreadShape phasedThread(double turns, double clearance_m = 0) {
  test::ThreadShape thread;
  thread.length_m = turns * thread.pitch_m;
  thread.clearance_m = clearance_m;
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  thread.face_steps = thread.side_steps = 2;
  return thread;
}

TEST(KnownOverlaps, ThreadsOutOfPhaseFitAfterATurn) {
  const DrawnPart nut = knownDrawn("nut", test::makeNut(phasedThread(3, 50e-6), 11e-3));
  DrawnPart rod = knownDrawn("rod", test::makeThreadedRod(phasedThread(5)));
  rod.X_WP.R = rotationFromVector(Vec3(0, 0, 40 * std::numbers::pi / 180));
  const CheckedPair pair = knownPair({nut, rod});
  EXPECT_EQ(pair.state, PairState::Thread) << pair.explanation;
  const std::string before = "a turn of ";
  const std::size_t at = pair.explanation.find(before);
  ASSERT_NE(at, std::string::npos) << pair.explanation;
  // A column of facets is 360/96 degrees wide, and the threads have room on both sides.
  EXPECT_NEAR(std::stod(pair.explanation.substr(at + before.size())), -40, 0.5 * 360 / 96)
      << pair.explanation;
}

TEST(KnownOverlaps, ALeftHandThreadAndAnotherPitchAreNamed) {
  const DrawnPart nut = knownDrawn("nut", test::makeNut(phasedThread(3, 50e-6), 11e-3));
  const Mesh rod = test::makeThreadedRod(phasedThread(5));
  const CheckedPair left = knownPair({nut, knownDrawn("rod", test::mirrored(rod))});
  EXPECT_EQ(left.state, PairState::Clash);
  EXPECT_NE(left.explanation.find("a left-hand thread in a right-hand one"), std::string::npos)
      << left.explanation;
  test::ThreadShape fine = phasedThread(5);
  fine.pitch_m = 1.25e-3;
  const CheckedPair other = knownPair({nut, knownDrawn("rod", test::makeThreadedRod(fine))});
  EXPECT_EQ(other.state, PairState::Clash);
  EXPECT_NE(other.explanation.find("different threads"), std::string::npos) << other.explanation;
}

TEST(KnownOverlaps, AnInsertIsOneByNameAndShapeOrByRule) {
  const auto parts = [](const char* name, double outer_m) {
    return std::vector<DrawnPart>{knownDrawn("housing", makeTube(8e-3, 2e-3, 8e-3, kSides)),
                                  knownDrawn(name, makeTube(outer_m, 1.25e-3, 5e-3, kSides))};
  };
  EXPECT_EQ(knownPair(parts("heat-set insert M3", 2.3e-3)).state, PairState::Insert);
  EXPECT_EQ(knownPair(parts("bush", 2.3e-3)).state, PairState::Clash);
  EXPECT_EQ(knownPair(parts("heat-set insert M3", 2.8e-3)).state, PairState::Clash);  // 29 % too wide
  const OverlapWishes declared{.rules = {{{"bush", "housing", "here"}, OverlapWish::Insert, {}}}};
  EXPECT_EQ(knownPair(parts("bush", 2.3e-3), declared).state, PairState::Insert);
}

TEST(KnownOverlaps, TheSizesOfAThreadAreOfOneSize) {
  EXPECT_EQ(metricThreadIn(8e-3, 6.647e-3), "M8");
  EXPECT_EQ(metricThreadIn(8e-3, 6.917e-3), "M8x1");
  EXPECT_EQ(metricThreadIn(5e-3, 3.242e-3), "");   // the hole of an M4
  EXPECT_EQ(metricThreadIn(1e-3, 0.9294e-3), "");  // the hole of an M1.2
  EXPECT_EQ(metricThreadIn(8.3e-3, 6.647e-3), "");
}

}  // namespace
}  // namespace vps::scenes
