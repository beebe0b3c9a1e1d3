// SPDX-License-Identifier: BSD-3-Clause
// Voxel and spacing from the sizes of parts and of the faces they fit; memory estimated before models are
// built.
#include "support/units.h"
#include "vps_scenes/planning/fidelity_choice.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ctime>

#include "models/meeting_sizes.h"
#include "models/scene_models.h"
#include "scenes/scene_part.h"
#include "simulation/scaled_scene.h"
#include "vps/errors.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/explain.h"
#include "vps_scenes/run/simulate.h"

namespace vps::scenes {
namespace {

/// A cube on a plate, in a scene that states no resolution.
Scene cubeOnPlate(double cube_m) {
  Scene scene;
  scene.file = scene.name = "cube";
  scene.parts = {scenePart("plate", makeBox(Vec3(3, 3, 1) * cube_m), {0, 0, -0.5 * cube_m}, true),
                 scenePart("cube", makeBox(Vec3::Constant(cube_m)), {0, 0, 0.5 * cube_m}, false)};
  scene.chooses_voxel = scene.chooses_spacing = true;
  return scene;
}

double voxelOf(const Scene& scene, std::size_t part) {
  return scene.parts[part].voxel_m > 0 ? scene.parts[part].voxel_m : scene.fidelity.voxel_m;
}

TEST(Resolution, OrdinaryPartsHaveThePresetsVoxelToTheLastBit) {
  for (const double cube_m : {2.0 * kMm, 3 * kMm, 20 * kMm, 60 * kMm}) {
    Scene scene = cubeOnPlate(cube_m);
    chooseResolution(scene);
    for (const std::size_t i : {0u, 1u}) EXPECT_EQ(voxelOf(scene, i), Fidelity().voxel_m) << cube_m;
    EXPECT_EQ(scene.resolution_choice, "");
  }
  Scene largest = cubeOnPlate(kLargestUsual_m);
  chooseResolution(largest);
  EXPECT_EQ(voxelOf(largest, 1), Fidelity().voxel_m);
}

TEST(Resolution, AtBothEdgesTheVoxelIsContinuous) {
  for (const double edge_m : {2 * kMm, kLargestUsual_m}) {
    Scene below = cubeOnPlate(edge_m * (1 - 1e-3)), above = cubeOnPlate(edge_m * (1 + 1e-3));
    chooseResolution(below);
    chooseResolution(above);
    EXPECT_NEAR(voxelOf(below, 1) / voxelOf(above, 1), 1, 3e-3) << edge_m;
    EXPECT_LT(voxelOf(below, 1), voxelOf(above, 1)) << edge_m;
  }
}

TEST(Resolution, ASmallPartIsEightVoxelsAcrossAndItsLargePlateIsNot) {
  Scene scene = cubeOnPlate(0.1 * kMm);
  scene.parts[0].part.mesh = makeBox({0.1, 0.1, 0.02});
  chooseResolution(scene);
  EXPECT_DOUBLE_EQ(voxelOf(scene, 1), 0.1 * kMm / kVoxelsAcross);
  EXPECT_EQ(voxelOf(scene, 0), Fidelity().voxel_m);
}

TEST(Resolution, TheModelsOfALargePartTakeNoMoreThanThoseOfACubeOf150Mm) {
  Scene usual = cubeOnPlate(kLargestUsual_m);
  usual.parts.erase(usual.parts.begin());
  const auto bytesOf = [](Scene& scene) {
    chooseResolution(scene);
    return static_cast<double>(estimate(scene, ModelPurpose::Simulate, {}).cost.most.bytes);
  };
  const double usual_bytes = bytesOf(usual);
  for (const double size_m : {0.5, 2.0, 20.0}) {
    Scene scene = cubeOnPlate(size_m);
    EXPECT_LT(bytesOf(scene), 2.3 * usual_bytes) << size_m;  // both parts
    EXPECT_NE(scene.resolution_choice.find("for 'cube'"), std::string::npos) << scene.resolution_choice;
  }
}

// Each part's voxmap is at its memory limit, and together they would take 50 times the limit of all models.
TEST(Resolution, TheModelsOfManyLargePartsTakeNoMoreThanThoseOfAPlannedScene) {
  Scene scene = cubeOnPlate(0.4);
  for (int i = 0; i < 50; ++i)
    scene.parts.push_back(scenePart("cube " + std::to_string(i), makeBox({0.4, 0.4, 0.4 + 0.001 * i}),
                                    {0.6 * (i + 1), 0, 0.3}, false));
  scene.parts.push_back(scenePart("small", makeBox(Vec3::Constant(20 * kMm)), {0, 1, 0.3}, false));
  chooseResolution(scene);
  EXPECT_LE(static_cast<double>(estimate(scene, ModelPurpose::Simulate, {}).cost.most.bytes),
            kMostModels_bytes);
  EXPECT_EQ(voxelOf(scene, scene.parts.size() - 1), Fidelity().voxel_m);
  EXPECT_NE(scene.resolution_choice.find("all models would take about"), std::string::npos)
      << scene.resolution_choice;
}

TEST(Resolution, PartsOfTheSameVoxelAreOneClauseThatNamesThree) {
  Scene scene = cubeOnPlate(10 * kMm);
  for (int i = 0; i < 500; ++i)
    scene.parts.push_back(scenePart("screw " + std::to_string(i), makeBox(Vec3::Constant(0.5 * kMm)),
                                    {0.1 + 0.001 * i, 0, 0}, false));
  chooseResolution(scene);
  EXPECT_EQ(scene.resolution_choice, "voxels of 62.5 um for 'screw 0', 'screw 1', 'screw 2' and 497 others");
}

TEST(Resolution, WhatIsStatedIsKept) {
  Scene scene = cubeOnPlate(0.1 * kMm);
  scene.chooses_voxel = false;
  chooseResolution(scene);
  EXPECT_EQ(voxelOf(scene, 1), Fidelity().voxel_m);
  scene.chooses_voxel = true;
  scene.chooses_spacing = false;
  chooseResolution(scene);
  EXPECT_LT(voxelOf(scene, 1), Fidelity().voxel_m);
  EXPECT_EQ(scene.parts[1].spacing_m, 0);
}

/// A wheel with a bore of this diameter, and a pin of 8 mm whose pivot is `pivot_m` thick.
Scene pivotInBore(double bore_m, double pivot_m) {
  Scene scene;
  scene.file = scene.name = "pivot";
  Mesh pin = makeCylinder(1 * kMm, 8 * kMm, 48);
  append(pin, transformed(makeCylinder(0.5 * pivot_m, 4 * kMm, 48), Pose::translation({0, 0, 6 * kMm})));
  scene.parts = {scenePart("wheel", makeTube(2 * kMm, 0.5 * bore_m, 3 * kMm, 48), {0, 0, 6 * kMm}, true),
                 scenePart("pin", pin, {0, 0, 0}, false)};
  scene.chooses_voxel = scene.chooses_spacing = true;
  return scene;
}

TEST(Resolution, ABoreAndWhatFitsIntoItAreResolvedAndOneIntoWhichNothingFitsIsNot) {
  Scene fits = pivotInBore(0.11 * kMm, 0.1 * kMm);
  chooseResolution(fits);
  EXPECT_NEAR(voxelOf(fits, 0), 0.11 * kMm / kVoxelsAcross, 0.01 * 0.11 * kMm / kVoxelsAcross);
  EXPECT_NEAR(voxelOf(fits, 1), 0.1 * kMm / kVoxelsAcross, 0.01 * 0.1 * kMm / kVoxelsAcross);
  EXPECT_NE(fits.resolution_choice.find("13.7 um for the fixed parts"), std::string::npos)
      << fits.resolution_choice;
  Scene misses = pivotInBore(0.1 * kMm, 0.5 * kMm);
  chooseResolution(misses);
  EXPECT_EQ(voxelOf(misses, 0), Fidelity().voxel_m);
  EXPECT_EQ(voxelOf(misses, 1), Fidelity().voxel_m);
}

TEST(WallSizes, AreThoseOfTubesAndBoxes) {
  const WallSizes tube = wallSizes(makeTube(1.5 * kMm, 0.5 * kMm, 5 * kMm, 64), 2 * kMm);
  EXPECT_NEAR(tube.thinnest_m, 1 * kMm, 0.01 * kMm);
  ASSERT_FALSE(tube.gaps_m.empty());
  EXPECT_NEAR(tube.gaps_m.front(), 1 * kMm, 0.01 * kMm);
  const WallSizes plate = wallSizes(makeBox({20 * kMm, 20 * kMm, 1.5 * kMm}), 2 * kMm);
  EXPECT_DOUBLE_EQ(plate.thinnest_m, 1.5 * kMm);
  EXPECT_TRUE(plate.gaps_m.empty());
}

/// The faces of a box, each divided into n x n squares.
Mesh dividedBox(const Vec3& size, int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
          Vec3 p;
          p[axis] = 0.5 * side * size[axis];
          p[u] = size[u] * (static_cast<double>(i) / n - 0.5);
          p[v] = size[v] * (static_cast<double>(k) / n - 0.5);
          mesh.vertices.push_back(p);
        }
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
          const auto a = base + static_cast<std::uint32_t>(i * (n + 1) + k),
                     b = a + static_cast<std::uint32_t>(n) + 1;
          if (side > 0)
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {{a, b + 1, b}, {a, a + 1, b + 1}});
        }
    }
  return mesh;
}

// The bore is a separate shell in the middle of the list; a part need not be one solid for its walls to be
// found.
TEST(WallSizes, ABoreOfAFewFacetsInAVeryFinePartIsFound) {
  for (const int facets : {12, 24, 64})
    for (const int n : {40, 150}) {  // 19200 and 270000 facets
      Mesh mesh = dividedBox({40 * kMm, 30 * kMm, 20 * kMm}, n);
      const Mesh tube = makeTube(3 * kMm, 0.5 * kMm, 5 * kMm, facets);
      append(mesh, transformed(tube, Pose::translation({30 * kMm, 1.3 * kMm, 0.7 * kMm})));
      append(mesh,
             transformed(dividedBox({40 * kMm, 30 * kMm, 20 * kMm}, n), Pose::translation({0, 60 * kMm, 0})));
      const WallSizes sizes = wallSizes(mesh, 2 * kMm);
      ASSERT_FALSE(sizes.gaps_m.empty()) << facets << ' ' << n;
      EXPECT_NEAR(sizes.gaps_m.front(), 1 * kMm, 0.05 * kMm) << facets << ' ' << n;
    }
}

TEST(WallSizes, BadMeshesHaveNone) {
  EXPECT_TRUE(wallSizes(Mesh(), 1).gaps_m.empty());
  Mesh damaged = makeBox({1, 1, 1});
  damaged.vertices[0].x() = std::nan("");
  EXPECT_TRUE(std::isinf(wallSizes(damaged, 2).thinnest_m));
}

TEST(Resolution, ATooLargeModelIsRefusedBeforeAnyIsBuiltWithTheKeyToSet) {
  Scene scene = cubeOnPlate(0.8);
  scene.parts[0].part.mesh = makeBox({0.1, 0.1, 0.02});
  scene.chooses_voxel = false;  // stated: 0.25 mm
  SimulateOptions options;
  options.progress = [](std::string_view doing, double) { ADD_FAILURE() << doing; };
  try {
    simulate(scene, 0.01, options);
    FAIL() << "was not refused";
  } catch (const LoadError& error) {
    const std::string words = error.what();
    for (const char* part : {"800 x 800 x 800 mm", "GiB", "[fidelity] voxel = \"0."})
      EXPECT_NE(words.find(part), std::string::npos) << words;
    // The voxel named in the message is accepted.
    double voxel_mm = 0;
    ASSERT_EQ(std::sscanf(words.c_str() + words.find("voxel = \"") + 9, "%lf", &voxel_mm), 1) << words;
    scene.fidelity.voxel_m = voxel_mm * kMm;
  }
  EXPECT_GT(scene.fidelity.voxel_m, Fidelity().voxel_m);
  EXPECT_LT(scene.fidelity.voxel_m, 2 * Fidelity().voxel_m);
}

// The voxel named in the message applies to all parts, and the models fit with it, although parts had their
// own voxels.
TEST(Resolution, TheVoxelThatIsNamedWhereMemoryIsShortFits) {
  Scene scene = cubeOnPlate(0.3);
  chooseResolution(scene);
  ASSERT_GT(scene.parts[1].voxel_m, 0);
  SimulateOptions options;
  options.memory_bytes = 20e6;
  double voxel_mm = 0, spacing_mm = 0;
  try {
    simulate(scene, 0.01, options);
    FAIL() << "was not refused";
  } catch (const LoadError& error) {
    const std::string words = error.what();
    const auto at = words.find("voxel = \"");
    ASSERT_NE(at, std::string::npos) << words;
    ASSERT_EQ(
        std::sscanf(words.c_str() + at, "voxel = \"%lfmm\", spacing = \"%lfmm\"", &voxel_mm, &spacing_mm), 2)
        << words;
  }
  for (ScenePart& part : scene.parts) part.voxel_m = part.spacing_m = 0;
  scene.fidelity.voxel_m = voxel_mm * kMm;
  scene.fidelity.spacing_m = spacing_mm * kMm;
  EXPECT_NO_THROW(simulate(scene, 0.002, options)) << voxel_mm;
  scene.fidelity.voxel_m *= 0.85;
  scene.fidelity.spacing_m *= 0.85;
  EXPECT_THROW(simulate(scene, 0.002, options), LoadError) << voxel_mm;
}

// Refusals by three limits: spacings that are far too small (pointshell), a plate of 15 m (voxmap), and
// voxels of a micrometre (memory).
TEST(Resolution, WhatIsNamedWhereModelsAreRefusedIsAcceptedAndFoundInASecond) {
  const std::array<double, 3> cases[] = {// cube, voxel and spacing [m]
                                         {10 * kMm, 0.25 * kMm, 1e-5}, {10 * kMm, 0.25 * kMm, 1e-6},
                                         {10 * kMm, 0.25 * kMm, 1e-7}, {10 * kMm, 1.2 * kMm, 4.8e-6},
                                         {10 * kMm, 1e-6, 0.5 * kMm},  {5, 0.25 * kMm, 1 * kMm},
                                         {0.5, 8 * kMm, 0.01 * kMm}};
  for (const double memory_bytes : {1e9, 16e9})
    for (const auto& [cube_m, voxel_m, spacing_m] : cases) {
      Scene scene = cubeOnPlate(cube_m);
      scene.chooses_voxel = scene.chooses_spacing = false;
      scene.fidelity.voxel_m = voxel_m;
      scene.fidelity.spacing_m = spacing_m;
      const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate, false);
      ModelOptions options;
      options.memory_bytes = memory_bytes;
      const std::clock_t begun = std::clock();
      try {
        requireModelsFit(scene, plan, options);
        ADD_FAILURE() << "was not refused: " << cube_m << " " << voxel_m << " " << spacing_m;
      } catch (const LoadError& error) {
        EXPECT_LT(static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC, 1.0) << error.what();
        const std::string words = error.what();
        const auto at = words.find("voxel = \"");
        ASSERT_NE(at, std::string::npos) << words;
        double voxel_mm = 0, spacing_mm = 0;
        ASSERT_EQ(
            std::sscanf(words.c_str() + at, "voxel = \"%lfmm\", spacing = \"%lfmm\"", &voxel_mm, &spacing_mm),
            2)
            << words;
        scene.fidelity.voxel_m = voxel_mm * kMm;
        scene.fidelity.spacing_m = spacing_mm * kMm;
        EXPECT_NO_THROW(requireModelsFit(scene, plan, options)) << words;
      }
    }
}

// All numbers of the two runs differ by powers of two only.
TEST(ScaledScene, ASmallSceneHasTheAnswersOfTheSimilarOneToTheLastBit) {
  const auto run = [](double factor, double gap_mm = 0.1) {
    Scene scene = cubeOnPlate(0.8 * kMm * factor);
    scene.parts[1].X_WP.p.z() += gap_mm * kMm * factor;
    scene.parts[1].V_WP_W.v = Vec3(0.02, 0, 0) * factor;
    scene.gravity_W *= factor;
    chooseResolution(scene);
    SimulateOptions options;
    options.judge_every = 1;
    return simulate(scene, 0.05, options);
  };
  const SimulateResult one = run(1), small = run(0x1p-6);
  ASSERT_TRUE(small.overlap);
  EXPECT_EQ(small.contact_depth_m * 0x1p6, one.contact_depth_m);
  EXPECT_EQ(small.exact.deepest.depth_m, small.max_penetration_m);
  EXPECT_EQ(small.exact.deepest.depth_m * 0x1p6, one.exact.deepest.depth_m);
  EXPECT_EQ(Vec3(small.exact.deepest.at_W * 0x1p6), one.exact.deepest.at_W);
  EXPECT_EQ(small.exact.bound_m * 0x1p6, one.exact.bound_m);
  const SimulateResult deep = run(1, -0.004), small_deep = run(0x1p-6, -0.004);
  EXPECT_GT(deep.exact.deepest.depth_m, 0);
  EXPECT_EQ(small_deep.exact.deepest.depth_m, small_deep.max_penetration_m);
  EXPECT_EQ(small_deep.exact.deepest.depth_m * 0x1p6, deep.exact.deepest.depth_m);
  EXPECT_GT(deep.contact_depth_m, 0);
  EXPECT_EQ(small_deep.contact_depth_m * 0x1p6, deep.contact_depth_m);
  EXPECT_EQ(small.overlap->limit_m, 10e-6);  // drawn lengths, independent of the scale of the simulation
  EXPECT_EQ(one.overlap->limit_m, 10e-6);
  EXPECT_EQ(Vec3(small.bodies[0].X_WP.p * 0x1p6), one.bodies[0].X_WP.p);
  EXPECT_EQ(small.bodies[0].X_WP.R, one.bodies[0].X_WP.R);
  EXPECT_EQ(small.kinetic_energy_J * 0x1p30, one.kinetic_energy_J);
}

TEST(ScaledScene, PartsOfAMillimetreAreSimulatedAsTheyAre) {
  EXPECT_EQ(simulationScale(cubeOnPlate(1 * kMm)), 1);
  EXPECT_EQ(simulationScale(cubeOnPlate(20)), 1);
  EXPECT_EQ(simulationScale(cubeOnPlate(0.99 * kMm)), 2);
  EXPECT_EQ(simulationScale(cubeOnPlate(20e-6)), 64);
}

}  // namespace
}  // namespace vps::scenes
