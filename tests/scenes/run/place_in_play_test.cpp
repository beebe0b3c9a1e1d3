// SPDX-License-Identifier: BSD-3-Clause
// Parts that are displaced at their targets, within and outside of their play, which is known by
// construction.
#include "step/place_in_play.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "fits/fits.h"
#include "support/lathe.h"
#include "support/units.h"

namespace vps::scenes {
namespace {

constexpr double kTouching_m = 10 * kUm;  // depth that counts as contact

JudgedBody playBody(const std::string& name, const Mesh& mesh) {
  VoxMapSettings voxels;
  voxels.voxel_m = 1e-3;
  PointShellSettings points;
  points.spacing_m = 2e-3;
  return makeJudgedBody(buildPartModel(name, mesh, voxels, points));
}

/// A part at its target, and the walls around it: boxes, each of 6 mm thickness.
struct Pocketed {
  JudgedBody body;
  OverlapJudge judge;
  Pose X_WP;

  [[nodiscard]] PlaceInPlay at(const Pose& X_error) const {
    return placeInPlay(judge, body, X_WP, X_WP.R.col(2), X_WP * X_error, kTouching_m);
  }
};

/// A box of the given size at the origin, between two walls at the given gaps to each side along x and y, of
/// the given length, on a floor.
/// @param gap_m     between the box and the walls at +-x and +-y; infinite: no wall
/// @param length_m  of the walls at +-x, along y
Pocketed pocketed(const Vec3& size_m, const std::array<double, 2>& gap_m, double length_m, const Pose& X_WP) {
  Pocketed out{playBody("part", makeBox(size_m)), {}, X_WP};
  constexpr double kWall_m = 6e-3;
  const auto wall = [&](const Vec3& wall_m, const Vec3& p) {
    out.judge.mount(playBody("wall", makeBox(wall_m)), X_WP * Pose::translation(p));
  };
  for (const int side : {-1, 1}) {
    const double x_m = 0.5 * (size_m.x() + kWall_m) + gap_m[0], y_m = 0.5 * (size_m.y() + kWall_m) + gap_m[1];
    wall({kWall_m, length_m, size_m.z()}, {side * x_m, 0, 0});
    if (std::isfinite(y_m)) wall({size_m.x(), kWall_m, size_m.z()}, {0, side * y_m, 0});
  }
  wall({size_m.x(), length_m, kWall_m}, {0, 0, -0.5 * (size_m.z() + kWall_m)});
  return out;
}

const Pose kOblique(rotationFromVector(Vec3(0.3, -0.5, 0.9)), Vec3(0.02, -0.01, 0.03));
constexpr double kNoWall = std::numeric_limits<double>::infinity();

// A tab whose clearances differ, 0.2 mm by 0.4 mm: by its tighter fit it may be off by 161 um, though it is
// off by 212 um where it touches its walls.
TEST(PlaceInPlay, ATabOfUnequalClearancesIsPlacedInAllCorners) {
  for (const double scale : {0.1, 1.0}) {
    const double a = scale * 0.1 * kMm, b = scale * 0.2 * kMm;
    const double tolerance_m = fitTolerance_m(2 * a);
    const Pocketed tab = pocketed({12 * kMm, 8 * kMm, 4 * kMm}, {a, b}, 8 * kMm, kOblique);
    for (const int i : {-1, 1})
      for (const int j : {-1, 1}) {
        const auto off = [&](double x_m, double y_m, double z_m) {
          return tab.at(Pose::translation({i * x_m, j * y_m, z_m}));
        };
        EXPECT_TRUE(off(a, b, 0).isPlaced(tolerance_m)) << scale << ": " << inWords(off(a, b, 0));
        EXPECT_TRUE(off(0.9 * a, 0.1 * b, 0).isPlaced(tolerance_m));
        // Along the insertion, the tab belongs on its floor.
        EXPECT_FALSE(off(a, b, tolerance_m + 5 * kUm).isPlaced(tolerance_m));
        EXPECT_TRUE(off(a, b, 0.5 * tolerance_m).isPlaced(tolerance_m));
        // No tab can be in its wall; if it were, the play would not explain more than the gap and contact.
        EXPECT_FALSE(off(a + tolerance_m + 2 * kTouching_m, 0, 0).isPlaced(tolerance_m));
      }
  }
}

TEST(PlaceInPlay, SaysThePlayAlongEachAxisAndHowFarOffThePartIs) {
  const Pocketed tab = pocketed({12 * kMm, 8 * kMm, 4 * kMm}, {100 * kUm, 200 * kUm}, 8 * kMm, Pose());
  const PlaceInPlay place = tab.at(Pose::translation({-100 * kUm, 0, 300 * kUm}));
  int told = 0;
  for (const AxisRoom& room : place.rooms) {
    if (room.off == 0 || room.is_turn) continue;
    ++told;
    if (std::abs(room.axis_W.x()) > 0.9) {
      EXPECT_NEAR(std::abs(room.off), 100 * kUm, kUm);
      for (const double way_m : room.way) EXPECT_NEAR(way_m, 100 * kUm + kTouching_m, 2 * kUm);
      EXPECT_EQ(place.outside(room), 0);
    } else {
      EXPECT_FALSE(room.isHeld());
      EXPECT_FALSE(room.isFree());
      EXPECT_NEAR(std::abs(place.outside(room)), 300 * kUm, kUm);
    }
  }
  EXPECT_EQ(told, 2);
  EXPECT_NEAR(place.outside_m, 300 * kUm, kUm);
  const std::string words = inWords(place);
  EXPECT_NE(words.find("100.0 um along x, where its play is -1"), std::string::npos) << words;
  EXPECT_NE(words.find("300.0 um along z, where it is stopped on one side only"), std::string::npos) << words;
}

// A beam in a slot that is shorter: it may turn by c / l in the slot, which moves its ends by more than c.
TEST(PlaceInPlay, ABeamIsPlacedAtEachYawThatItsShorterSlotAllows) {
  constexpr double kGap_m = 0.2 * kMm, kSlot_m = 16 * kMm;
  const double tolerance_m = fitTolerance_m(2 * kGap_m);
  for (const double ratio : {2.5, 5.0, 10.0}) {
    const Pocketed beam = pocketed({10 * kMm, ratio * kSlot_m, 10 * kMm}, {kGap_m, kNoWall}, kSlot_m, Pose());
    const double most_rad = 2 * kGap_m / kSlot_m;
    const auto turned = [&](double share, double z_m) {
      return beam.at(Pose(rotationFromVector({0, 0, share * most_rad}), Vec3(0, 0, z_m)));
    };
    for (const double share : {-0.98, 0.5, 0.98})
      EXPECT_TRUE(turned(share, 0).isPlaced(tolerance_m))
          << ratio << ", " << share << ": " << inWords(turned(share, 0));
    EXPECT_FALSE(turned(1.5 + 4 * tolerance_m / (ratio * kGap_m), 0).isPlaced(tolerance_m)) << ratio;
    EXPECT_FALSE(turned(0.5, 0.5 * kMm).isPlaced(tolerance_m)) << ratio;
    // Along the slot nothing stops the beam: it belongs where the eye puts it.
    EXPECT_TRUE(beam.at(Pose::translation({0, 0.45 * kMm, 0})).isPlaced(tolerance_m));
    EXPECT_FALSE(beam.at(Pose::translation({0, 0.6 * kMm, 0})).isPlaced(tolerance_m));
  }
}

Mesh ball(double radius_m) {
  constexpr int kRows = 24;
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= kRows; ++i) {
    const double a = std::numbers::pi * (double(i) / kRows - 0.5);
    profile.push_back({i == 0 || i == kRows ? 0 : radius_m * std::cos(a), radius_m * std::sin(a)});
  }
  return test::lathe(profile, 2 * kRows);
}

Mesh cup(double bore_m, double depth_m) {
  return test::lathe({{0, -depth_m - 4 * kMm},
                      {12 * kMm, -depth_m - 4 * kMm},
                      {12 * kMm, 0},
                      {bore_m, 0},
                      {bore_m, -depth_m},
                      {0, -depth_m}},
                     96);
}

// A ball of 8 mm in a blind hole: it rolls from wall to wall and turns about all axes.
TEST(PlaceInPlay, ABallThatRollsInItsHoleMovesWithinItsPlay) {
  constexpr double kBall_m = 4 * kMm;
  for (const auto& [depth_m, gap_m] : {std::pair(5 * kMm, 50 * kUm), std::pair(10 * kMm, 200 * kUm)}) {
    Pocketed in{playBody("ball", ball(kBall_m)), {}, Pose::translation({0, 0, kBall_m - depth_m})};
    in.judge.mount(playBody("cup", cup(kBall_m + gap_m, depth_m)), Pose());
    const auto rolled = [&](const Vec3& by_W, double turn_rad) {
      const Mat3 R = rotationFromVector(Vec3(0.2 * turn_rad, turn_rad, 0.1 * turn_rad));
      const Pose X_from = in.X_WP * Pose::translation({-0.5 * gap_m, 0, 0});
      return movedWithinPlay(in.judge, in.body, in.X_WP, Vec3::UnitZ(), X_from, Pose(R, X_from.p + by_W),
                             kTouching_m);
    };
    EXPECT_TRUE(rolled({1.4 * gap_m, 0.1 * gap_m, 0}, 0.3));
    EXPECT_TRUE(rolled({0, 0.5 * gap_m, 0}, 1.1));
    EXPECT_FALSE(rolled({0, 0, 40 * kUm}, 0));                // it leaves its floor
    EXPECT_FALSE(rolled({1.5 * gap_m + 50 * kUm, 0, 0}, 0));  // it would be in the wall
  }
}

// A cube that turns in a wide hole moves within no play: its surface is not mapped to itself.
TEST(PlaceInPlay, ACubeThatTurnsOnATableIsNotAtRest) {
  Pocketed in{playBody("cube", makeBox({8 * kMm, 8 * kMm, 8 * kMm})), {}, Pose::translation({0, 0, 4 * kMm})};
  in.judge.mount(playBody("table", makeBox({40 * kMm, 40 * kMm, 4 * kMm})),
                 Pose::translation({0, 0, -2 * kMm}));
  const auto moved = [&](const Pose& X_WP) {
    return movedWithinPlay(in.judge, in.body, in.X_WP, Vec3::UnitZ(), in.X_WP, X_WP, kTouching_m);
  };
  EXPECT_FALSE(moved(in.X_WP * Pose(rotationFromVector({0, 0, 0.02}), Vec3::Zero())));
  EXPECT_FALSE(moved(in.X_WP * Pose::translation({50 * kUm, 0, 0})));
  EXPECT_TRUE(moved(in.X_WP * Pose::translation({5 * kUm, 0, 0})));
}

// A shaft along its bore: free along its axis and about it, held across.
TEST(PlaceInPlay, AShaftInAThroughBoreIsFreeAlongItAndHeldAcross) {
  constexpr double kShaft_m = 5 * kMm;
  const Mesh shaft =
      test::lathe({{0, -20 * kMm}, {kShaft_m, -20 * kMm}, {kShaft_m, 20 * kMm}, {0, 20 * kMm}}, 96);
  for (const double gap_m : {40 * kUm, 100 * kUm, 200 * kUm}) {
    const double outer_m = 12 * kMm, bore_m = kShaft_m + gap_m;
    Pocketed in{playBody("shaft", shaft), {}, Pose()};
    in.judge.mount(
        playBody("plate",
                 test::lathe({{bore_m, 0}, {outer_m, 0}, {outer_m, 8 * kMm}, {bore_m, 8 * kMm}}, 96)),
        Pose());
    const double tolerance_m = 20 * kUm;
    const auto placed = [&](const Vec3& by_W, const Vec3& turn_W) {
      return in.at(Pose(rotationFromVector(turn_W), by_W)).isPlaced(tolerance_m);
    };
    EXPECT_TRUE(placed({0.95 * gap_m, 0, 0}, Vec3::Zero()));
    EXPECT_TRUE(placed({0, 0, 0.4 * kMm}, Vec3::Zero()));
    EXPECT_TRUE(placed({0, 0, 0}, {0, 0, 0.7}));
    EXPECT_FALSE(placed({0, 0, 0.6 * kMm}, Vec3::Zero()));
    EXPECT_FALSE(placed({gap_m + 60 * kUm, 0, 0}, Vec3::Zero()));
  }
}

}  // namespace
}  // namespace vps::scenes
