// SPDX-License-Identifier: BSD-3-Clause
// Voxels of planned scenes, chosen from the sizes of the parts and the memory limit.
#include <gtest/gtest.h>

#include <numbers>

#include "scenes/assemblies_to_plan.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/explain.h"

namespace vps::scenes {
namespace {

/// A block of this size on a plate of ten times its width.
Scene blockOnPlate(double block_m) {
  const DrawnPart plate = at("plate", makeBox(Vec3(10, 10, 1) * block_m), {0, 0, -0.5 * block_m});
  const DrawnPart part = at("part", makeBox(Vec3(1, 1, 2) * block_m), {0, 0, block_m});
  const std::vector<DrawnPart> parts = {plate, part};
  return plannedScenes(sceneOf(parts), planAssembly("test", parts)).front();
}

double bytesOf(const Scene& scene) {
  return static_cast<double>(estimate(scene, ModelPurpose::Assemble, {}).cost.most.bytes);
}

TEST(FitFidelity, APartOfManyVoxelsKeepsThePresetsVoxelsAndHasPointsEveryFour) {
  Scene scene = blockOnPlate(8e-3);
  EXPECT_EQ(fitFidelity(scene), "");
  EXPECT_EQ(scene.fidelity.voxel_m, Fidelity().voxel_m);
  EXPECT_DOUBLE_EQ(scene.fidelity.spacing_m, 4 * Fidelity().voxel_m);
}

TEST(FitFidelity, ASmallPartIsEightVoxelsAcross) {
  Scene scene = blockOnPlate(1e-3);
  const std::string words = fitFidelity(scene);
  EXPECT_DOUBLE_EQ(scene.fidelity.voxel_m, 0.125e-3);
  EXPECT_DOUBLE_EQ(scene.fidelity.spacing_m, 0.25e-3);
  EXPECT_NE(words.find("'part' is 1.00 mm across"), std::string::npos) << words;
}

// Each step of the voxel size halves the memory; one step finer exceeds the limit.
TEST(FitFidelity, AsFineAsTheMemoryAllows) {
  constexpr double kMost_bytes = 20e6;
  Scene scene = blockOnPlate(50e-3);
  ASSERT_GT(bytesOf(scene), kMost_bytes);
  const std::string words = fitFidelity(scene, kMost_bytes);
  EXPECT_NE(words.find("the models would take about"), std::string::npos) << words;
  EXPECT_EQ(words.find("may be missed"), std::string::npos) << words;
  EXPECT_LE(bytesOf(scene), kMost_bytes);
  scene.fidelity.voxel_m /= std::numbers::sqrt2;
  scene.fidelity.spacing_m /= std::numbers::sqrt2;
  EXPECT_GT(bytesOf(scene), kMost_bytes);
}

TEST(FitFidelity, WhereMemoryLeavesASmallPartTooFewVoxelsItIsNamed) {
  Scene scene = blockOnPlate(8e-3);
  const std::string words = fitFidelity(scene, 10e3);
  EXPECT_GT(scene.fidelity.voxel_m, 1e-3);
  EXPECT_NE(words.find("'part', 8.00 mm across, is less than eight voxels"), std::string::npos) << words;
  // Voxels finer than the preset's may take only a fifth of the memory limit.
  scene = blockOnPlate(1e-3);
  const double preset_bytes = bytesOf(scene);
  const std::string small_words = fitFidelity(scene, 5 * preset_bytes);
  EXPECT_EQ(scene.fidelity.voxel_m, Fidelity().voxel_m);
  EXPECT_NE(small_words.find("'part', 1.00 mm across"), std::string::npos) << small_words;
}

TEST(FitFidelity, OfASceneThatStatesOnlyTheSpacingTheVoxelIsChosen) {
  Scene scene = blockOnPlate(1e-3);
  scene.chooses_voxel = true;
  scene.chooses_spacing = false;
  scene.fidelity.spacing_m = 0.7e-3;
  chooseResolution(scene);
  EXPECT_DOUBLE_EQ(scene.fidelity.voxel_m, 0.125e-3);
  EXPECT_EQ(scene.fidelity.spacing_m, 0.7e-3);
  EXPECT_NE(scene.resolution_choice, "");
}

TEST(FitFidelity, WhatASceneStatesIsKept) {
  Scene scene = blockOnPlate(1e-3);
  scene.fidelity.voxel_m = 0.2e-3;
  EXPECT_EQ(fitFidelity(scene), "");
  EXPECT_EQ(scene.fidelity.voxel_m, 0.2e-3);
  scene = blockOnPlate(1e-3);
  scene.fidelity_wish.emplace();
  EXPECT_EQ(fitFidelity(scene), "");
  EXPECT_EQ(scene.fidelity.voxel_m, Fidelity().voxel_m);
}

// Two blocks that are drawn in each other. The hand tries only briefly, since the drawing has to be
// corrected.
TEST(FitFidelity, AStepThatIsDrawnThroughAnotherPartIsTriedForHalfASecond) {
  const auto timeout = [](double deep_m) {
    const std::vector<DrawnPart> parts = {
        at("plate", makeBox(Vec3(0.1, 0.1, 0.02)), {0, 0, -0.01}),
        at("block", makeBox(Vec3(0.02, 0.02, 0.02)), {0, 0, 0.01 - deep_m})};
    return plannedScenes(sceneOf(parts), planAssembly("test", parts)).front().steps.front().timeout_s;
  };
  EXPECT_EQ(timeout(2e-3), 0.5);
  EXPECT_GE(timeout(0.5e-3), SceneStep().timeout_s);
  EXPECT_GE(timeout(0), SceneStep().timeout_s);
}

}  // namespace
}  // namespace vps::scenes
