// SPDX-License-Identifier: BSD-3-Clause
// Which parts are modelled again when a part leaves the region of its step.
#include "world/placed_parts.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/scene_models.h"
#include "scenes/scene_part.h"
#include "vps/box.h"

namespace vps::scenes {
namespace {

/// Two plates 200 mm apart; each plate has a contact model only where its own pin is set down.
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

/// A block that slides at 0.5 m/s on the fixed or mounted part at y.
double slid_m(Simulation& simulation, std::size_t block, double y_m) {
  simulation.addBody(block, Pose::translation({0, y_m, 4 * kMm}));
  Twist V;
  V.v = {0.5, 0, 0};
  simulation.setTwist(block, V);
  for (int i = 0; i < 30; ++i) simulation.step(1e-3);
  const double x_m = simulation.pose(block).p.x();
  simulation.removeBody(block);
  return x_m;
}

// v t - mu g t^2 / 2, integrated with the velocity at the end of each step.
double slides_m(double mu) {
  return 0.5 * 0.03 - mu * 9.81 * 1e-6 * 30 * 31 / 2;
}

TEST(PlacedParts, AMountedPartKeepsItsOwnFriction) {
  Scene scene;
  scene.file = scene.name = "plates";
  const Mesh plate = makeBox({60 * kMm, 10 * kMm, 4 * kMm});
  scene.parts = {scenePart("base", plate, Vec3::Zero(), true),
                 scenePart("mounted", plate, {0, 20 * kMm, 0}, false),
                 scenePart("block", makeBox({8 * kMm, 6 * kMm, 4 * kMm}), {0, 0, 4 * kMm}, false)};
  const double mu[] = {0.8, 0.1, 0.5};
  for (const std::size_t i : {0u, 1u, 2u}) scene.parts[i].part.material.friction = mu[i];
  ModelOptions options;
  options.models_everything = true;
  ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate, true);
  buildModels(scene, plan, options);
  Simulation simulation(scene, plan);
  PlacedParts placed(scene, plan, simulation, options);
  for (const std::size_t part : {0u, 1u}) {
    placed.add(part, scene.parts[part].X_WP);
    placed.setField(cookField(placed.orderFor(0).value()));
  }
  for (const std::size_t part : {0u, 1u}) {
    const double expected_m = slides_m(std::sqrt(mu[part] * mu[2]));
    EXPECT_NEAR(slid_m(simulation, 2, 20 * kMm * static_cast<double>(part)), expected_m, 0.01 * expected_m);
  }
  simulation.addBody(2, scene.parts[2].X_WP);
  const auto contacts = simulation.fieldContacts(2);
  ASSERT_EQ(contacts.size(), 2U);
  for (const std::size_t part : {0u, 1u})
    EXPECT_DOUBLE_EQ(contacts[part].friction, std::sqrt(mu[part]) * std::sqrt(mu[2]));
}

}  // namespace
}  // namespace vps::scenes
