// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "scenes/scene_part.h"
#include "support/lathe.h"
#include "support/units.h"
#include "vps/box.h"
#include "vps/errors.h"
#include "vps_scenes/scene/model_options.h"

namespace vps::scenes {
namespace {

/// Tubes of different sizes; every third one lacks some triangles.
Scene tubes(int count) {
  Scene scene;
  scene.file = scene.name = "tubes";
  for (int i = 0; i < count; ++i) {
    Mesh mesh = makeTube((5 + i) * kMm, 3 * kMm, 10 * kMm, 24);
    if (i % 3 == 1) mesh.triangles.resize(mesh.triangles.size() - 3);
    scene.parts.push_back(scenePart("tube_" + std::to_string(i), mesh, {30 * kMm * i, 0, 0}, false));
  }
  return scene;
}

struct Built {
  Scene scene;
  std::vector<std::string> warnings;
};

Built built(Scene scene, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Built out;
  ModelOptions options;
  options.warn = [&](const std::string& text) { out.warnings.push_back(text); };
  buildModels(scene, options);
  out.scene = std::move(scene);
  return out;
}

TEST(SceneModels, AnyNumberOfThreadsGivesTheSameBitsAndWarnings) {
  const Built one = built(tubes(7), 1);
  EXPECT_EQ(one.warnings.size(), 2u);
  for (const std::size_t threads : {2u, 8u}) {
    const Built many = built(tubes(7), threads);
    EXPECT_EQ(many.warnings, one.warnings);
    for (std::size_t i = 0; i < 7; ++i) {
      const PartModel &a = *one.scene.parts[i].model, &b = *many.scene.parts[i].model;
      EXPECT_EQ(a.shell->points, b.shell->points) << i;
      EXPECT_EQ(a.shell->order, b.shell->order) << i;
      EXPECT_EQ(a.map->memoryBytes(), b.map->memoryBytes()) << i;
      for (double z = -6; z < 6; z += 0.13)
        EXPECT_EQ(a.map->distance({4 * kMm, 1 * kMm, z * kMm}), b.map->distance({4 * kMm, 1 * kMm, z * kMm}));
    }
  }
}

TEST(SceneModels, TheFirstPartThatCannotBeModelledIsNamed) {
  Scene scene = tubes(7);
  for (const std::size_t bad : {2u, 5u}) scene.parts[bad].part.mesh.vertices[0].x() = NAN;
  for (const std::size_t threads : {1u, 8u}) {
    try {
      built(scene, threads);
      ADD_FAILURE() << "expected a LoadError";
    } catch (const LoadError& error) {
      EXPECT_NE(std::string(error.what()).find("tube_2"), std::string::npos) << error.what();
    }
  }
}

// Progress may throw to stop the build; no part may be begun after that on one thread.
TEST(SceneModels, ProgressGrowsAndStopsTheBuildByThrowing) {
  Scene scene = tubes(7);
  ModelOptions options;
  std::vector<double> shares;
  options.progress = [&](std::string_view, double share) { shares.push_back(share); };
  buildModels(scene, options);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.back(), 1);
  shares.erase(std::unique(shares.begin(), shares.end()),
               shares.end());  // inner loops repeat the latest report
  EXPECT_EQ(shares.size(), 8u);

  Scene again = tubes(7);
  options.progress = [](std::string_view, double) { throw std::runtime_error("stopped"); };
  EXPECT_THROW(buildModels(again, options), std::runtime_error);
  for (const ScenePart& part : again.parts) EXPECT_EQ(part.model, nullptr);
}

TEST(ShrunkMesh, EachFaceIsMovedInwards) {
  const double by_m = 10e-6;
  const Mesh box = makeBox(Vec3(1e-3, 2e-3, 3e-3));
  const Mesh small = shrunkMesh(box, by_m);
  EXPECT_LT((bounds(small).size() - (bounds(box).size() - Vec3::Constant(2 * by_m))).norm(), 1e-12);
  const Mesh rod = test::lathe({{0, 0}, {4e-3, 0}, {4e-3, 9e-3}, {0, 9e-3}}, 128);
  // The volume within a prism of 128 sides.
  const double flat = std::cos(std::numbers::pi / 128), face_m = 4e-3 * flat - by_m,
               area = 128 * std::tan(std::numbers::pi / 128);
  EXPECT_NEAR(massProperties(shrunkMesh(rod, by_m)).volume_m3, area * face_m * face_m * (9e-3 - 2 * by_m),
              1e-15);
}

// Warnings of meshes whose inside may be uncertain.
MeshReport ofTwoShells() {
  MeshReport report;
  report.shells = 2;
  report.signed_by_winding = true;
  return report;
}

TEST(MeshWarning, AClosedBlockWithAVoidGivesNone) {
  EXPECT_EQ(meshWarning(ofTwoShells()), "");
}

TEST(MeshWarning, AHoleIsNamedWithWhatItLeavesUncertain) {
  MeshReport report = ofTwoShells();
  report.open_edges = 4;
  report.certain_share = 0.91229;
  const std::string words = meshWarning(report);
  EXPECT_EQ(words.find("is not a closed surface: 2 shells, 4 open edges"), 0U) << words;
  EXPECT_NE(words.find("certain for 91.22 % of the space near the surface"), std::string::npos) << words;
}

TEST(MeshWarning, OverlappingShellsAreNotCalledOpen) {
  MeshReport report = ofTwoShells();
  report.overlapping_shells = 2;
  const std::string words = meshWarning(report);
  EXPECT_EQ(words.find("is repaired: "), 0U) << words;
  EXPECT_NE(words.find("2 overlapping shells"), std::string::npos) << words;
}

}  // namespace
}  // namespace vps::scenes
