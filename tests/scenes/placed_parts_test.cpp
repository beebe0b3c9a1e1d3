// SPDX-License-Identifier: BSD-3-Clause
// What is modelled anew when a part leaves the region of its step.
#include "procedure/placed_parts.h"

#include <gtest/gtest.h>

#include "models/scene_models.h"
#include "scenes/scene_part.h"
#include "vps/box.h"

namespace vps::scenes {
namespace {

constexpr double kMm = 1e-3;

/// Two plates 200 mm apart, each modelled where a pin of its own is set down on it.
Scene pinsOnTwoPlates() {
  Scene scene;
  scene.file = scene.name = "pins";
  scene.parts = {scenePart("near", makeBox({40 * kMm, 40 * kMm, 2 * kMm}), Vec3::Zero(), true),
                 scenePart("far", makeBox({42 * kMm, 40 * kMm, 2 * kMm}), {200 * kMm, 0, 0}, true),
                 scenePart("pin", makeBox({2 * kMm, 2 * kMm, 2 * kMm}), {0, 0, 2 * kMm}, false),
                 scenePart("twin", makeBox({2 * kMm, 2 * kMm, 3 * kMm}), {200 * kMm, 0, 2.5 * kMm}, false)};
  for (const std::size_t part : {2u, 3u}) {
    SceneStep step;
    step.part = part;
    step.X_WP_target = scene.parts[part].X_WP;
    step.X_WP_start = Pose::translation(scene.parts[part].X_WP.p + Vec3(0, 0, 0.2 * kMm));
    scene.steps.push_back(step);
  }
  return scene;
}

TEST(PlacedParts, AGrownRegionModelsOnlyThosePartsAnewThatReachIntoIt) {
  Scene scene = pinsOnTwoPlates();
  ModelPlan plan = makeModelPlan(scene, ModelPurpose::Assemble);
  ModelOptions options;
  buildModels(scene, plan, options);
  ASSERT_TRUE(scene.parts[0].is_cropped && scene.parts[1].is_cropped);
  Simulation simulation(scene, plan);
  PlacedParts placed(scene, plan, simulation, options);
  for (const std::size_t part : {0u, 1u}) placed.add(part, scene.parts[part].X_WP);
  placed.renewJudge();
  const std::shared_ptr<const PartModel> near = scene.parts[0].model, far = scene.parts[1].model;
  placed.widen(0, bounds(scene.parts[2].part.mesh), scene.parts[2].X_WP);
  EXPECT_GT(scene.parts[0].model->shell->size(), near->shell->size());
  EXPECT_EQ(scene.parts[1].model, far) << "nothing of it is in the grown region";
}

}  // namespace
}  // namespace vps::scenes
