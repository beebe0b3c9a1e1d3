// SPDX-License-Identifier: BSD-3-Clause
// Trade studies of speed against accuracy: the measured rows, and the choice of a fidelity. The file has more
// than 400 lines because the tests share its scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <new>
#include <random>

#include "models/scene_models.h"
#include "record/scene_archive.h"
#include "study/variants.h"
#include "support/random_draw.h"
#include "support/stl_box.h"
#include "support/temporary_folder.h"
#include "trade/probe.h"
#include "trade/trade_plan.h"
#include "vps/errors.h"
#include "vps/mesh_distance.h"
#include "vps/voxmap.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/trade.h"

namespace vps::scenes {
namespace {

constexpr double kRadius_m = 3e-3;
constexpr int kRings = 5;  // gives facets of about 0.2 mm

/// A ball over a plate; no setting was tuned on this scene.
Scene ballOnPlate() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({12e-3, 12e-3, 3e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"ball", makeSphere(kRadius_m, kRings), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  const double top_m = 1.5e-3;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, top_m + kRadius_m});
  scene.steps[0].X_WP_start = Pose::translation({0, 0, top_m + kRadius_m + 0.2e-3});
  scene.fidelity.voxel_m = 0.5e-3;
  scene.fidelity.spacing_m = 0.5e-3;
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.hand.aim_error_m = 0;
  scene.hand.aim_error_rad = 0;
  scene.release_s = 0.1;
  return scene;
}

/// The row for a plate that is pushed 20 um into a ball, offset and rotated. Only the plate's points are
/// tested, so that the depth comes from the ball's curved field alone.
TradeRow rowAt(double voxel_m, double spacing_m) {
  Scene scene = ballOnPlate();
  std::swap(scene.parts[0].part, scene.parts[1].part);
  scene.fidelity.sides = Sides::One;
  const Mat3 R = rotationFromVector({0.3, 0.2, 0.1});
  const Pose X_WP(R, -(R * Vec3(0.31e-3, 0.17e-3, 1.5e-3 + kRadius_m - 20e-6)));
  buildModels(scene, {});
  const Probe probe(scene, {X_WP}, {});
  EXPECT_EQ(probe.posesInside(), 1u);
  scene.fidelity.voxel_m = voxel_m;
  scene.fidelity.spacing_m = spacing_m;
  for (ScenePart& part : scene.parts) part.model.reset();
  buildModels(scene, {});
  TradeRow row;
  row.setting.fidelity = scene.fidelity;
  row.bytes = modelledCost(scene).bytes;
  probe.measure(scene, row);
  return row;
}

TEST(Trade, AFinerVoxelIsMoreAccurateAndLarger) {
  const double s = 0.125e-3;
  // Coarser voxels are not tested: with 1 mm neither the field nor the points find the contact, which is only
  // 20 um deep.
  const TradeRow coarse = rowAt(0.5e-3, s), middle = rowAt(0.25e-3, s), fine = rowAt(0.125e-3, s);
  EXPECT_LT(middle.probe.penetration_m, coarse.probe.penetration_m);
  EXPECT_LT(fine.probe.penetration_m, middle.probe.penetration_m);
  EXPECT_GT(middle.bytes, coarse.bytes);
  EXPECT_GT(fine.bytes, middle.bytes);
  // Trilinear error in a ball's field: h^2/8 times the sum of its second derivatives, 2/r. The plate's
  // nearest point lies within s of the deepest point, where the ball is s^2/(2 r) farther away. OverlapJudge
  // is accurate to 0.5 um.
  const double h = 0.125e-3, inner_m = kRadius_m - 20e-6;
  EXPECT_LE(fine.probe.penetration_m, h * h / (4 * inner_m) + s * s / (2 * inner_m) + 0.5e-6);
}

TEST(Trade, FinerPointsGiveAMoreAccurateForce) {
  EXPECT_LT(rowAt(0.125e-3, 0.125e-3).probe.force, rowAt(0.125e-3, 1e-3).probe.force);
}

TEST(Trade, MorePointsTakeMoreTime) {
  // An eighth of the spacing gives 64 times the points, and an exhaustive query reads each of them. The test
  // only requires four times the time, since a loaded machine with cold caches reduced the ratio of 64 to 14.
  double few_us = 1e9, many_us = 1e9;
  for (int i = 0; i < 3; ++i) {
    const TradeRow few = rowAt(0.25e-3, 1e-3), many = rowAt(0.25e-3, 0.125e-3);
    EXPECT_GT(many.points_read, few.points_read);
    few_us = std::min(few_us, few.all_points.cpu_p50_us);
    many_us = std::min(many_us, many.all_points.cpu_p50_us);
  }
  EXPECT_GT(many_us, 4 * few_us);
}

TEST(Trade, TheScenesOwnSettingIsRunAndTheOthersAreMeasuredOrListedAsLeftOut) {
  TradeOptions options;
  options.seconds = 1e-3;  // time for the first row only
  const Scene scene = ballOnPlate();
  const TradeResult result = trade(scene, options);
  ASSERT_EQ(result.rows.size(), 1u);
  EXPECT_TRUE(result.rows[0].has_run);
  EXPECT_EQ(result.excerpt, "step 1 of 1: ball");
  EXPECT_EQ(result.left_out.size(),
            tradeDesign(scene).size());  // the design includes the reference and excludes the first setting
  EXPECT_EQ(result.fixed.size(), 2u);
}

/// Progress that acts at the second report about a row: the first report announces the row, the second comes
/// from its run.
Progress inRow(const std::string& name, const std::function<void()>& act) {
  return [name, act, count = 0](std::string_view doing, double) mutable {
    if (doing == name && ++count == 2) act();
  };
}

TEST(Trade, ARowThatFailsIsLeftOutWithTheReasonAndTheOthersAreMeasured) {
  const std::function<void()> failures[] = {[] { throw LoadError("", "ball", "is too fine to be modelled"); },
                                            [] { throw std::bad_alloc(); }};
  const char* const reasons[] = {"all coarser: part 'ball': is too fine", "all coarser: needed more memory"};
  for (std::size_t i = 0; i < 2; ++i) {
    TradeOptions options;
    options.seconds = 20;
    std::atomic<bool> stop = false;
    const Progress fail = inRow("all coarser", failures[i]), end = inRow("voxel x2", [&] { stop = true; });
    options.stop = &stop;
    options.progress = [&](std::string_view doing, double share) {
      fail(doing, share);
      end(doing, share);
    };
    const TradeResult result = trade(ballOnPlate(), options);
    ASSERT_FALSE(result.left_out.empty());
    EXPECT_EQ(result.left_out[0].find(reasons[i]), 0u) << result.left_out[0];
    const auto after = std::find_if(result.rows.begin(), result.rows.end(),
                                    [](const TradeRow& row) { return row.setting.name == "spacing x2"; });
    ASSERT_NE(after, result.rows.end());
    EXPECT_TRUE(after->has_run);
    const auto failed = std::find_if(result.rows.begin(), result.rows.end(),
                                     [](const TradeRow& row) { return row.setting.name == "all coarser"; });
    ASSERT_NE(failed, result.rows.end()) << "its models were measured before it failed";
    EXPECT_TRUE(failed->has_probe);
    EXPECT_FALSE(failed->has_run);
  }
}

TEST(Trade, AStoppedTradeKeepsTheMeasuredRowsAndReportsTheStop) {
  TradeOptions options;
  std::atomic<bool> stop = false;
  options.stop = &stop;
  options.progress = inRow("all coarser", [&] { stop = true; });
  const TradeResult result = trade(ballOnPlate(), options);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_TRUE(result.rows[0].has_run);
  EXPECT_FALSE(result.rows[1].has_run);
  ASSERT_EQ(result.left_out.size(), 2u);
  EXPECT_EQ(result.left_out[0], "all coarser: its run was stopped");
  EXPECT_EQ(result.left_out[1].find("stopped"), 0u);
}

TEST(Trade, AnExcerptHoldsItsStepAndThePartsInPlaceByThen) {
  Scene scene = ballOnPlate();
  scene.parts.push_back(scene.parts[1]);
  scene.parts[2].part.name = "second";
  scene.parts.push_back(scene.parts[1]);
  scene.parts[3].part.name = "third";
  scene.steps.push_back(scene.steps[0]);
  scene.steps[1].part = 2;
  scene.steps.push_back(scene.steps[0]);
  scene.steps[2].part = 3;
  const Scene excerpt = excerptOf(scene, 1);
  ASSERT_EQ(excerpt.parts.size(), 3u);
  EXPECT_TRUE(excerpt.parts[1].is_fixed);
  EXPECT_EQ(excerpt.parts[1].X_WP.p, scene.steps[0].X_WP_target.p);
  EXPECT_EQ(excerpt.parts[excerpt.steps.at(0).part].part.name, "second");
  EXPECT_EQ(excerpt.hand.seed, scene.hand.seed + 1);
}

TradeRow judged(double step_us, double error_m, std::size_t bytes) {
  TradeRow row;
  row.has_run = row.has_probe = row.run.completed = true;
  row.run.physics.cpu_p99_us = step_us;
  row.probe.penetration_m = error_m;
  row.bytes = bytes;
  return row;
}

TEST(Trade, TheFrontHoldsTheRowsThatNoOtherDominates) {
  // Only the second row dominates the third, in one criterion; likewise the fourth dominates the last but
  // one.
  std::vector<TradeRow> rows = {judged(100, 5e-6, 10), judged(200, 1e-6, 20), judged(200, 2e-6, 20),
                                judged(300, 1e-6, 5),  judged(300, 1e-6, 6),  judged(50, 9e-6, 99)};
  rows.back().run.completed = false;  // fast, but not completed
  markFront(rows);
  EXPECT_TRUE(rows[0].is_on_front);
  EXPECT_TRUE(rows[1].is_on_front);
  EXPECT_FALSE(rows[2].is_on_front);
  EXPECT_TRUE(rows[3].is_on_front);
  EXPECT_FALSE(rows[4].is_on_front);
  EXPECT_FALSE(rows[5].is_on_front);
}

TEST(Trade, AnswersLeaveOutSettingsWithALargeForceError) {
  TradeResult result;
  result.rows = {judged(100, 5e-6, 10), judged(400, 4e-6, 10)};
  result.rows[0].setting.name = "fast";
  result.rows[0].probe.force = 2.2;
  result.rows[1].setting.name = "slow";
  result.rows[1].probe.force = 0.1;
  for (const std::string& answer : tradeAnswers(result)) {
    EXPECT_EQ(answer.find("'fast'"), std::string::npos) << answer;
    EXPECT_NE(answer.find("'slow'"), std::string::npos) << answer;
  }
  result.rows.pop_back();
  for (const std::string& answer : tradeAnswers(result))
    EXPECT_NE(answer.find("no answer"), std::string::npos) << answer;
}

/// Error of depth that 95 of 100 points near a surface do not exceed, at points that the test draws itself.
double errorAtOtherPoints(const PartModel& part, double reach_m) {
  const MeshDistance exact(*part.mesh);
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> errors;
  double total = 0;
  std::vector<double> until;
  for (const auto& [a, b, c] : part.mesh->triangles) {
    const Vec3 &p = part.mesh->vertices[a], &q = part.mesh->vertices[b], &r = part.mesh->vertices[c];
    until.push_back(total += (q - p).cross(r - p).norm());
  }
  for (int i = 0; i < 4000; ++i) {
    const auto at = std::lower_bound(until.begin(), until.end(), share(random) * total) - until.begin();
    const auto& [a, b, c] = part.mesh->triangles[static_cast<std::size_t>(at)];
    double u = share(random), v = share(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3 aside = test::drawnVector(share, random) - Vec3::Constant(0.5);
    const Vec3 p = part.mesh->vertices[a] + u * (part.mesh->vertices[b] - part.mesh->vertices[a]) +
                   v * (part.mesh->vertices[c] - part.mesh->vertices[a]) + 2 * reach_m * aside;
    errors.push_back(std::abs(part.map->distance(p) - exact.signedDistance(p)));
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() * 95 / 100];
}

TEST(FidelityChoice, KeepsItsToleranceOnAnotherSceneAtOtherPoints) {
  for (const double tolerance_m : {20e-6, 5e-6, 2e-6}) {
    Scene scene = ballOnPlate();
    FidelityWish wish;
    wish.tolerance_m = tolerance_m;
    const FidelityChoice choice = chooseFidelity(scene, wish);
    ASSERT_TRUE(choice.is_met) << choice.failure_reason;
    for (const ScenePart& part : scene.parts) {
      ASSERT_TRUE(part.model && part.model->map);
      EXPECT_EQ(part.model->map->voxel_m(), choice.fidelity.voxel_m);
      EXPECT_LE(errorAtOtherPoints(*part.model, tolerance_m), tolerance_m) << part.part.name;
    }
  }
}

TEST(FidelityChoice, KeepsItsMemoryAndItsBudgetOfPoints) {
  Scene scene = ballOnPlate();
  buildModels(scene, {});
  FidelityWish wish;
  wish.memory_bytes =
      1.4 * static_cast<double>(modelledCost(scene).bytes);  // with the cooked field the factor would be 2
  const FidelityChoice small = chooseFidelity(scene, wish);
  ASSERT_TRUE(small.is_met) << small.failure_reason;
  EXPECT_LE(2 * static_cast<double>(modelledCost(scene).bytes), *wish.memory_bytes);

  Scene again = ballOnPlate();
  again.fidelity.spacing_m = 0.05e-3;
  FidelityWish quick;
  quick.budget_hz = 1000;  // 1000 us: the model leaves 600 us for points, which is 10,909 points
  const FidelityChoice few = chooseFidelity(again, quick);
  ASSERT_TRUE(few.is_met) << few.failure_reason;
  const std::size_t sides = few.fidelity.sides == Sides::Both ? 2 : 1;
  EXPECT_LE(sides * again.parts[1].model->shell->size(), 10910u);
  EXPECT_GT(few.fidelity.spacing_m, 0.05e-3);  // fewer points were chosen before other changes
  EXPECT_EQ(few.fidelity.voxel_m, ballOnPlate().fidelity.voxel_m);
}

TEST(FidelityChoice, TakesOneSideForARateAloneButNotWithATolerance) {
  FidelityWish wish;
  wish.budget_hz = 1e6 / (kStepBase_us + 0.2);  // allows 4 points, fewer than both sides have at any spacing
  Scene scene = ballOnPlate();
  EXPECT_EQ(chooseFidelity(scene, wish).fidelity.sides, Sides::One);
  wish.tolerance_m = 20e-6;
  scene = ballOnPlate();
  const FidelityChoice kept = chooseFidelity(scene, wish);
  EXPECT_EQ(kept.fidelity.sides, Sides::Both);
  EXPECT_NE(kept.failure_reason.find("larger tolerance"), std::string::npos) << kept.failure_reason;
}

TEST(FidelityChoice, NamesTheBoundThatCannotBeKept) {
  Scene scene = ballOnPlate();
  FidelityWish wish;
  wish.budget_hz = 1e5;
  EXPECT_NE(chooseFidelity(scene, wish).failure_reason.find("allow a lower rate"), std::string::npos);
  wish = {};
  wish.memory_bytes = 10;
  EXPECT_NE(chooseFidelity(scene, wish).failure_reason.find("allow more memory"), std::string::npos);
  wish = {};
  wish.tolerance_m = 1e-12;
  EXPECT_FALSE(chooseFidelity(scene, wish).is_met);
}

// With voxels halved down to 15 um, the maps of the ball and the plate would take at least 256 MB.
TEST(FidelityChoice, BuildsNoMapThatWouldNotFitIntoMemory) {
  Scene scene = ballOnPlate();
  FidelityWish wish;
  wish.tolerance_m = 0.01e-6;  // makes the search continue to the finest voxel
  const FidelityChoice none = chooseFidelity(scene, wish, {.progress = {}, .machine_bytes = 40e6});
  EXPECT_FALSE(none.is_met);
  EXPECT_NE(none.failure_reason.find("half of this machine's memory"), std::string::npos)
      << none.failure_reason;
  wish.memory_bytes = 2e6;
  const FidelityChoice small = chooseFidelity(scene, wish);
  EXPECT_FALSE(small.is_met);
  EXPECT_NE(small.failure_reason.find("only 2 MB are allowed"), std::string::npos) << small.failure_reason;
  // Without a tolerance there is no search, and the scene's own maps are already too large.
  wish = {};
  wish.budget_hz = 1;
  EXPECT_FALSE(chooseFidelity(scene, wish, {.progress = {}, .machine_bytes = 1e4}).is_met);
  EXPECT_FALSE(scene.parts[0].model) << "it was built nevertheless";
}

// Flat, round and thin parts, and a part of many small faces.
TEST(FidelityChoice, TheEstimatedMemoryOfMapsIsAtLeastTheirOwnAndAtMostTheStatedMultiple) {
  const Mesh meshes[] = {makeBox({12e-3, 12e-3, 3e-3}), makeSphere(3e-3, 5), makeBox({30e-3, 30e-3, 0.3e-3}),
                         makeCylinder(4e-3, 15e-3, 64)};
  for (const Mesh& mesh : meshes)
    for (const double voxel_m : {0.25e-3, 0.125e-3, 0.0625e-3}) {
      VoxMapSettings settings;
      settings.voxel_m = voxel_m;
      const double kept = static_cast<double>(buildVoxMap(mesh, settings).memoryBytes());
      EXPECT_GE(expectedMapBytes(mesh, settings), 0.9 * kept) << voxel_m;
      EXPECT_LE(expectedMapBytes(mesh, settings), 2.5 * kept) << voxel_m;
    }
}

TEST(FidelityChoice, AnAutomaticFidelityIsTheSameEachTimeAndIsRecorded) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "plate.stl", std::ios::binary) << stlBox(Vec3(20, 20, 5));
  const std::string file = folder.path() / "scene.toml";
  std::ofstream(file) << "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\n[fidelity]\nauto = true\n"
                         "tolerance = 0.05\n";
  Scene scene = loadScene(file), again = loadScene(file);
  EXPECT_THROW(buildModels(scene, {}), LoadError) << "the fidelity was not chosen yet";
  resolveFidelity(scene);
  resolveFidelity(again);
  EXPECT_FALSE(scene.fidelity_wish);
  EXPECT_FALSE(scene.fidelity_choice.empty());
  EXPECT_EQ(scene.fidelity_choice, again.fidelity_choice);
  EXPECT_EQ(sceneToBytes(scene), sceneToBytes(again));
  const Scene back = sceneFromBytes(sceneToBytes(scene), "x");
  EXPECT_EQ(back.fidelity.voxel_m, scene.fidelity.voxel_m);
  EXPECT_EQ(back.fidelity.spacing_m, scene.fidelity.spacing_m);
}

TEST(FidelityChoice, AWishThatCannotBeMetIsRefusedWithItsLine) {
  Scene scene = ballOnPlate();
  resolveFidelity(scene);  // without a wish it changes nothing
  EXPECT_EQ(scene.fidelity_choice, "");
  scene.fidelity_wish.emplace().memory_bytes = 1;
  scene.fidelity_wish->place = "scene.toml:4";
  try {
    resolveFidelity(scene);
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_EQ(std::string(error.what()).find("scene.toml:4: key 'fidelity' is auto and cannot be met: "), 0u)
        << error.what();
  }
}

TEST(FidelityChoice, ItsLinesGiveTheSameFidelityInASceneFile) {
  Fidelity fidelity;
  fidelity.voxel_m = 0.125e-3;
  fidelity.sides = Sides::One;
  fidelity.contact_limit = 7;
  fidelity.contact_method = ContactMethod::Penalty;
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "plate.stl", std::ios::binary) << stlBox(Vec3(20, 20, 5));
  std::ofstream(folder.path() / "scene.toml") << "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\n"
                                              << toToml(fidelity);
  const Fidelity back = loadScene(folder.path() / "scene.toml").fidelity;
  EXPECT_DOUBLE_EQ(back.voxel_m, fidelity.voxel_m);
  EXPECT_EQ(back.sides, Sides::One);
  EXPECT_EQ(back.contact_limit, 7);
  EXPECT_EQ(back.contact_method, ContactMethod::Penalty);
}

}  // namespace
}  // namespace vps::scenes
