// SPDX-License-Identifier: BSD-3-Clause
// Differences of two revisions that are known by construction.
#include "vps_scenes/fits/revisions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/drawn_part.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/revision_fields.h"

namespace vps::scenes {
namespace {

const CheckSettings kRevisionSettings{.has_play = false, .has_places = true};

/// A checked list of parts.
struct CheckedRevision {
  std::vector<DrawnPart> parts;
  CheckResult result;
  explicit CheckedRevision(std::vector<DrawnPart> drawn, const CheckSettings& settings = kRevisionSettings)
      : parts(std::move(drawn)), result(checkAssembly("revision", parts, settings)) {}
};

RevisionChanges changesOf(const CheckedRevision& before, const CheckedRevision& after) {
  return compareRevisions({before.parts, before.result}, {after.parts, after.result});
}

RevisionChanges changesOf(std::vector<DrawnPart> before, std::vector<DrawnPart> after) {
  return changesOf(CheckedRevision(std::move(before)), CheckedRevision(std::move(after)));
}

constexpr int kSides = 96;
/// The parts of the tests: a plate with its top at z = 0, and pins that stand on it.
DrawnPart revisedPlate(double top_m = 0) {
  return part("plate", makeBox(Vec3(0.1, 0.1, 0.02)), Pose::translation(Vec3(0, 0, top_m - 0.01)));
}
DrawnPart revisedPin(const std::string& name, const Vec3& foot_W, double height_m = 0.02) {
  return part(name, makeCylinder(5e-3, height_m, kSides),
              Pose::translation(foot_W + Vec3(0, 0, 0.5 * height_m)));
}
DrawnPart revisedTube(double bore_m) {
  return part("tube", makeTube(15e-3, 0.5 * bore_m, 20e-3, kSides));
}
DrawnPart revisedShaft(double diameter_m) {
  return part("shaft", makeCylinder(0.5 * diameter_m, 30e-3, kSides));
}

TEST(Revisions, TheSameAssemblyHasNoChanges) {
  const std::vector<DrawnPart> parts = {revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))};
  const RevisionChanges changes = changesOf(parts, parts);
  EXPECT_TRUE(changes.isSame());
  EXPECT_EQ(changes.old_verdict, Verdict::Fits);
}

// The pin is raised by 0.1 mm, so that its clearance grows by the same length.
TEST(Revisions, AMovedPartHasItsMotionAndTheChangeOfItsClearance) {
  const RevisionChanges changes = changesOf({revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))},
                                            {revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.15e-3))});
  ASSERT_EQ(changes.parts.size(), 1U);
  const PartChange& pin = changes.parts[0];
  EXPECT_EQ(pin.name, "pin");
  EXPECT_TRUE(pin.is_moved);
  EXPECT_FALSE(pin.is_reshaped || pin.is_renamed || pin.is_added || pin.is_removed);
  EXPECT_NEAR((pin.by_W - Vec3(0, 0, 0.1e-3)).norm(), 0, 1e-12);
  EXPECT_NEAR(pin.turn_W.norm(), 0, 1e-9);
  EXPECT_EQ(motionWords(pin), "0.1000 mm along +z");
  ASSERT_EQ(changes.pairs.size(), 1U);
  EXPECT_NEAR(changes.pairs[0].old_gap_m, 0.05e-3, 1e-9);
  EXPECT_NEAR(changes.pairs[0].new_gap_m, 0.15e-3, 1e-9);
}

TEST(Revisions, ATurnedPartHasItsRotation) {
  const double turn_rad = 0.01;
  const DrawnPart block =
      part("block", makeBox(Vec3(0.02, 0.02, 0.02)), Pose::translation(Vec3(0, 0, 0.011)));
  DrawnPart turned = block;
  turned.X_WP.R = rotationFromVector(Vec3(0, 0, turn_rad));
  const RevisionChanges changes = changesOf({revisedPlate(), block}, {revisedPlate(), turned});
  ASSERT_EQ(changes.parts.size(), 1U);
  EXPECT_NEAR(changes.parts[0].by_W.norm(), 0, 1e-12);
  EXPECT_NEAR((changes.parts[0].turn_W - Vec3(0, 0, turn_rad)).norm(), 0, 1e-9);
  // A corner is 10 mm times the root of 2 from the axis.
  EXPECT_NEAR(changes.parts[0].most_m, 2 * std::sqrt(2.0) * 10e-3 * std::sin(0.5 * turn_rad), 1e-9);
}

// The file has no frames: the same motion is in the corners of the mesh.
TEST(Revisions, AMotionOfThePartsMeshIsAMotionAndNoChangeOfItsShape) {
  const Pose motion(rotationFromVector(Vec3(0, 0.2, 0)), Vec3(0, 0, 0.85e-3));
  DrawnPart baked = revisedPin("pin", Vec3(0, 0, 0.05e-3));
  baked.mesh = transformed(baked.mesh, motion);
  const RevisionChanges changes =
      changesOf({revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))}, {revisedPlate(), baked});
  ASSERT_EQ(changes.parts.size(), 1U);
  EXPECT_TRUE(changes.parts[0].is_moved);
  EXPECT_FALSE(changes.parts[0].is_reshaped);
  EXPECT_NEAR((changes.parts[0].turn_W - Vec3(0, 0.2, 0)).norm(), 0, 1e-9);
}

// The radius of the bore grows by 50 um; the wall's facets are 0.54 thousandths of the radius inside it.
TEST(Revisions, AWiderBoreChangesShapeVolumeAndFit) {
  const RevisionChanges changes =
      changesOf({revisedTube(10e-3), revisedShaft(9.98e-3)}, {revisedTube(10.1e-3), revisedShaft(9.98e-3)});
  ASSERT_EQ(changes.parts.size(), 1U);
  const PartChange& tube = changes.parts[0];
  EXPECT_TRUE(tube.is_reshaped);
  EXPECT_FALSE(tube.is_moved);
  EXPECT_NEAR(tube.deviation_m, 50e-6, 1e-6);
  EXPECT_LE(tube.deviation_error_m, 1e-6);
  const double per_radius2 = 0.5 * kSides * std::sin(2 * std::numbers::pi / kSides) * 20e-3;
  EXPECT_NEAR(tube.old_shape->volume_m3 - tube.new_shape->volume_m3,
              per_radius2 * (5.05e-3 * 5.05e-3 - 25e-6), 1e-14);
  ASSERT_EQ(changes.fits.size(), 1U);
  EXPECT_NEAR(changes.fits[0].old_clearance_m, 20e-6, 1e-9);
  EXPECT_NEAR(changes.fits[0].new_clearance_m, 120e-6, 1e-9);
  EXPECT_FALSE(changes.fits[0].is_added || changes.fits[0].is_removed);
}

// 10 mm: H7 is 10.000 to 10.015, g6 is 9.986 to 9.995, k6 is 10.001 to 10.010 (ISO 286-2). 9.990 is not in
// h6, and 10.005 is neither in js6 nor in m6.
TEST(Revisions, AnotherFitOfIso286IsNamed) {
  const RevisionChanges changes = changesOf({revisedTube(10.007e-3), revisedShaft(9.990e-3)},
                                            {revisedTube(10.007e-3), revisedShaft(10.005e-3)});
  ASSERT_EQ(changes.fits.size(), 1U);
  EXPECT_EQ(changes.fits[0].old_standard, "H7/g6");
  EXPECT_EQ(changes.fits[0].new_standard, "H7/k6");
  EXPECT_EQ(standardWords(changes.fits[0]), "H7/g6 -> H7/k6");
}

// A hole that no corner of the old mesh is near: only points within its wall show it.
TEST(Revisions, AHoleThroughAPlateIsAsDeepAsItsMiddleIsFromTheFaces) {
  const RevisionChanges changes = changesOf({part("disc", makeCylinder(20e-3, 8e-3, kSides))},
                                            {part("disc", makeTube(20e-3, 5e-3, 8e-3, kSides))});
  ASSERT_EQ(changes.parts.size(), 1U);
  EXPECT_TRUE(changes.parts[0].is_reshaped);
  // The middle of the removed disc is 5 mm from the new wall; 4 mm is the middle of the wall's height.
  EXPECT_NEAR(changes.parts[0].deviation_m, 5e-3 * std::cos(std::numbers::pi / kSides), 0.06e-3);
}

TEST(Revisions, ARenamedPartIsFoundByShapeAndPlace) {
  const RevisionChanges changes = changesOf({revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))},
                                            {revisedPlate(), revisedPin("dowel", Vec3(0, 0, 0.05e-3))});
  ASSERT_EQ(changes.parts.size(), 1U);
  EXPECT_EQ(changes.parts[0].name, "dowel");
  EXPECT_EQ(changes.parts[0].old_name, "pin");
  EXPECT_TRUE(changes.parts[0].is_renamed);
  EXPECT_FALSE(changes.parts[0].is_moved || changes.parts[0].is_reshaped);
  EXPECT_TRUE(changes.pairs.empty());
}

TEST(Revisions, AnotherNameAndAnotherPlaceIsAnotherPart) {
  const RevisionChanges changes = changesOf({revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))},
                                            {revisedPlate(), revisedPin("dowel", Vec3(0.01, 0, 0.05e-3))});
  ASSERT_EQ(changes.parts.size(), 2U);
  EXPECT_TRUE(changes.parts[0].is_added);
  EXPECT_EQ(changes.parts[0].name, "dowel");
  EXPECT_TRUE(changes.parts[1].is_removed);
  EXPECT_EQ(changes.parts[1].old_name, "pin");
}

TEST(Revisions, ARemovedPartIsListedWithoutItsPairs) {
  const RevisionChanges changes = changesOf(
      {revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3)), revisedPin("post", Vec3(0.03, 0, 0.05e-3))},
      {revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.05e-3))});
  ASSERT_EQ(changes.parts.size(), 1U);
  EXPECT_TRUE(changes.parts[0].is_removed);
  EXPECT_EQ(changes.parts[0].old_name, "post");
  EXPECT_TRUE(changes.pairs.empty());
}

// The import numbers equal parts in the order of the file.
TEST(Revisions, InstancesInAnotherOrderAreNoChange) {
  const Vec3 left(-0.03, 0, 0.05e-3), right(0.03, 0, 0.05e-3);
  const RevisionChanges changes =
      changesOf({revisedPlate(), revisedPin("pin", left), revisedPin("pin_2", right)},
                {revisedPin("pin", right), revisedPin("pin_2", left), revisedPlate()});
  EXPECT_TRUE(changes.isSame());
}

TEST(Revisions, ANumberedPartOfAnotherShapeIsNoInstance) {
  const Vec3 left(-0.03, 0, 0.05e-3), right(0.03, 0, 0.05e-3);
  const RevisionChanges changes =
      changesOf({revisedPlate(), revisedPin("pin", left), revisedPin("pin_2", right, 0.04)},
                {revisedPlate(), revisedPin("pin", right), revisedPin("pin_2", left, 0.04)});
  ASSERT_EQ(changes.parts.size(), 2U);
  for (const PartChange& change : changes.parts) {
    EXPECT_TRUE(change.is_moved);
    EXPECT_NEAR(std::abs(change.by_W.x()), 0.06, 1e-12);
  }
}

// 1.2 mm is more than any part may be moved to free an overlap.
TEST(Revisions, AClashChangesTheVerdictsOfPairPartsAndAssembly) {
  DrawnPart plate = revisedPlate();
  plate.is_fixed = true;
  const RevisionChanges changes = changesOf({plate, revisedPin("pin", Vec3(0, 0, 0.05e-3))},
                                            {plate, revisedPin("pin", Vec3(0, 0, -1.2e-3))});
  EXPECT_EQ(changes.old_verdict, Verdict::Fits);
  EXPECT_EQ(changes.new_verdict, Verdict::Blocked);
  ASSERT_EQ(changes.pairs.size(), 1U);
  EXPECT_EQ(stateChangeWords(changes.pairs[0]), "apart -> clash");
  ASSERT_EQ(changes.parts.size(), 2U);  // the plate changed its verdict only
  EXPECT_EQ(changeWords(changes.parts[0]), "other verdict");
  EXPECT_EQ(verdictWords(changes.parts[1]), "fits -> blocked");
}

TEST(Revisions, PartsThatCameNearAreAPair) {
  const RevisionChanges changes = changesOf({revisedPlate(), revisedPin("pin", Vec3(0, 0, 3e-3))},
                                            {revisedPlate(), revisedPin("pin", Vec3(0, 0, 0.5e-3))});
  ASSERT_EQ(changes.pairs.size(), 1U);
  EXPECT_EQ(changes.pairs[0].old_state, "not near");
  EXPECT_TRUE(std::isnan(changes.pairs[0].old_gap_m));
  EXPECT_NEAR(changes.pairs[0].new_gap_m, 0.5e-3, 1e-9);
}

// The pin is lowered within its play: 50 um more room above, 50 um less below.
TEST(Revisions, PlayIsComparedInEachDirection) {
  CheckSettings settings = kRevisionSettings;
  settings.has_play = true;
  const auto between = [&](double foot_m) {
    DrawnPart roof = part("roof", makeBox(Vec3(0.1, 0.1, 0.02)), Pose::translation(Vec3(0, 0, 0.0302)));
    return CheckedRevision(
        {revisedPlate(),
         part("block", makeBox(Vec3(0.02, 0.02, 0.02)), Pose::translation(Vec3(0, 0, foot_m + 0.01))), roof},
        settings);
  };
  const RevisionChanges changes = changesOf(between(0.1e-3), between(0.05e-3));
  double grown_m = 0, shrunk_m = 0;
  for (const PlayChange& change : changes.play) {
    if (change.part != "block" || change.is_turn) continue;
    const double by_m = change.new_play - change.old_play;
    (by_m > 0 ? grown_m : shrunk_m) += by_m;
  }
  EXPECT_NEAR(grown_m, 50e-6, 1e-6);
  EXPECT_NEAR(shrunk_m, -50e-6, 1e-6);
}

}  // namespace
}  // namespace vps::scenes
