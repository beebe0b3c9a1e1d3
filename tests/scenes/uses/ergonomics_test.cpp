// SPDX-License-Identifier: BSD-3-Clause
// Arms and reach with angles that follow from a drawing.
#include "vps_scenes/uses/ergonomics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/peg_in_cup.h"
#include "vps/mesh.h"

namespace vps::scenes {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRounding_rad = 1e-6;  // error of an arc cosine near 1: root of a double's rounding

const Body kBody{"somebody", 1.70};
const double kUpper_m = kBody.upperArm_m(), kFore_m = kBody.forearm_m();

TEST(Arm, AForearmAheadOfAHangingUpperArmIsARightAngle) {
  const ArmPose arm = armTo(kBody, {0, kFore_m, -kUpper_m});
  EXPECT_NEAR(arm.elbow_rad, 90 * kDegree, kRounding_rad);
  EXPECT_NEAR(arm.raised_rad, 0, kRounding_rad);
  EXPECT_EQ(rulaArm(arm), kBestRula);
}

TEST(Arm, AStretchedArmAheadIsRaisedByARightAngle) {
  const ArmPose arm = armTo(kBody, {0, kUpper_m + kFore_m, 0});
  EXPECT_NEAR(arm.reach_share, 1, 1e-12);
  EXPECT_NEAR(arm.elbow_rad, 0, kRounding_rad);
  EXPECT_NEAR(arm.raised_rad, 90 * kDegree, kRounding_rad);
  EXPECT_EQ(rulaArm(arm), 3 + 2);
}

TEST(Arm, TheReachIsASphereAroundTheShoulder) {
  const double reach_m = kUpper_m + kFore_m;
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 1, 1), Vec3(-1, 2, -3)}) {
    const Vec3 edge = reach_m * direction.normalized();
    EXPECT_TRUE(armTo(kBody, 0.999 * edge).is_reached);
    EXPECT_FALSE(armTo(kBody, 1.001 * edge).is_reached);
    EXPECT_NEAR(armTo(kBody, 1.25 * edge).reach_share, 1.25, 1e-12);
  }
}

TEST(Arm, TheScoreChangesAtTheAnglesOfRula) {
  const auto at = [](double raised_deg, double elbow_deg) {
    return rulaArm({0.5, raised_deg * kDegree, elbow_deg * kDegree, true});
  };
  EXPECT_EQ(at(20, 80), 2);
  EXPECT_EQ(at(21, 80), 3);
  EXPECT_EQ(at(45, 80), 3);
  EXPECT_EQ(at(46, 80), 4);
  EXPECT_EQ(at(90, 80), 4);
  EXPECT_EQ(at(91, 80), 5);
  EXPECT_EQ(at(0, 59), 3);
  EXPECT_EQ(at(0, 60), 2);
  EXPECT_EQ(at(0, 100), 2);
  EXPECT_EQ(at(91, 101), kWorstRula);
}

/// A row of the trace with the peg's centre of mass at p_W.
TraceRow rowAt(const Scene& scene, double time_s, const Vec3& p_W) {
  TraceRow row;
  row.time_s = time_s;
  row.step = 0;
  row.X_WP.p = p_W - massProperties(scene.parts[1].part.mesh).com;
  return row;
}

/// The first seated person.
const StepErgonomics& seated(const Ergonomics& of) {
  return of.steps.at(0);
}

TEST(Ergonomics, APartThatHangsBeforeTheElbowIsHeldWithBestScore) {
  const Scene scene = pegInCup({});
  // The cup is 14 mm deep and 18 mm wide about the origin; its lowest point touches the bench.
  const Body& body = assumedBodies()[0];
  const double shoulder_m = -14e-3 + body.shoulderHeight_m(Posture::Seated) -
                            kSeatedBench_m;  // height of the shoulders above the origin
  const double ahead_m = body.forearm_m(), y_shoulder = -9e-3 - kToShoulder_m;
  const Vec3 easy(body.shoulderAside_m(), y_shoulder + ahead_m, shoulder_m - body.upperArm_m());
  const std::vector<TraceRow> trace{rowAt(scene, 0, easy), rowAt(scene, 2, easy)};
  const Ergonomics measured = measureErgonomics(scene, trace);
  ASSERT_EQ(measured.steps.size(), 4U);  // two persons, seated and standing
  EXPECT_EQ(seated(measured).body, body.name);
  EXPECT_EQ(seated(measured).posture, Posture::Seated);
  EXPECT_EQ(seated(measured).hand, "right");
  EXPECT_NEAR(seated(measured).elbow_most_rad, 90 * kDegree, 1e-4);  // the cup's flats stay within 5 um
  EXPECT_NEAR(seated(measured).raised_rad, 0, 1e-4);
  EXPECT_EQ(seated(measured).rula_mean, kBestRula);
  EXPECT_EQ(seated(measured).out_of_reach_share, 0);
}

TEST(Ergonomics, TimeOutOfReachIsCounted) {
  const Scene scene = pegInCup({});
  const Vec3 near(0, 0, 0), far(0, 1.5, 0);
  // The hand is near for one second and at 1.5 m for three seconds; the row at rest does not count.
  std::vector<TraceRow> trace{rowAt(scene, 0, near), rowAt(scene, 1, near), rowAt(scene, 4, far),
                              rowAt(scene, 9, far)};
  trace.back().phase = static_cast<int>(TracePhase::Rest);
  for (const StepErgonomics& of : measureErgonomics(scene, trace).steps) {
    EXPECT_NEAR(of.out_of_reach_share, 0.75, 1e-12) << of.body;
    EXPECT_EQ(of.rula_worst, kWorstRula);
    EXPECT_GT(of.greatest_reach, 1);
  }
}

TEST(Ergonomics, APartOnTheLeftIsTakenWithTheLeftHand) {
  const Scene scene = pegInCup({});
  const std::vector<TraceRow> trace{rowAt(scene, 0, {-0.3, 0, 0}), rowAt(scene, 1, {-0.3, 0, 0})};
  for (const StepErgonomics& of : measureErgonomics(scene, trace).steps) EXPECT_EQ(of.hand, "left");
}

TEST(Ergonomics, NothingIsMeasuredWhereUpIsNotAlongZ) {
  Scene scene = pegInCup({});
  scene.gravity_W = Vec3(0, -9.81, 0);
  EXPECT_TRUE(measureErgonomics(scene, {rowAt(scene, 0, {0, 0, 0})}).steps.empty());
}

}  // namespace
}  // namespace vps::scenes
