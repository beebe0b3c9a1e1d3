// SPDX-License-Identifier: BSD-3-Clause
// Assemblies that continue from parts that were put down before.
#include "vps_scenes/run/derived_scenes.h"

#include <gtest/gtest.h>

#include <atomic>

#include "scenes/two_pins.h"
#include "support/recorded.h"
#include "vps/box.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

/// Two pins in lockstep.
Scene pins() {
  Scene scene = twoPins();
  scene.fidelity.physics_rate_hz = scene.fidelity.haptic_rate_hz;
  return scene;
}

/// The result of the first step of two pins, and the pose at which it left its pin.
PutDown leftPin(AssembleResult* whole = nullptr) {
  Scene scene = pins();
  PutDown left{1, {}};
  AssembleOptions options;
  options.on_step = [&left](const AssembleResult& so_far) {
    if (so_far.steps.size() == 1) left.X_WP = so_far.finished.bodies[1].X_WP;
  };
  AssembleResult result = assemble(scene, options);
  if (whole != nullptr) *whole = std::move(result);
  return left;
}

TEST(PutDown, AfterAStepIsTakenBackTheSameMotionGivesTheSameBits) {
  AssembleResult whole;
  const PutDown left = leftPin(&whole);
  ASSERT_EQ(whole.steps.size(), 2u);
  const auto goOn = [&] {
    Scene rest = sceneFromStep(pins(), 1, std::span(&left, 1));
    return assemble(rest);
  };
  const AssembleResult once = goOn(), again = goOn();
  test::expectSame(once, again);
  ASSERT_EQ(once.steps.size(), 1u);
  EXPECT_EQ(once.steps[0].part, "right");
  EXPECT_EQ(once.steps[0].verdict, whole.steps[1].verdict);
  // A part that was put down keeps its pose to the bit in later steps.
  const Pose& X_WP = once.finished.bodies[1].X_WP;
  EXPECT_EQ(X_WP.p, left.X_WP.p);
  EXPECT_EQ(X_WP.R, left.X_WP.R);
  EXPECT_EQ(whole.finished.bodies[1].X_WP.p, left.X_WP.p);
}

TEST(PutDown, StepsKeepTheSeedThatTheyHaveInTheWholeProcedure) {
  const PutDown left{1, {}};
  const Scene scene = twoPins();
  EXPECT_EQ(sceneFromStep(scene, 1, std::span(&left, 1)).hand.seed, scene.hand.seed + 1);
  EXPECT_EQ(sceneFromStep(scene, 0, {}).hand.seed, scene.hand.seed);
}

TEST(PutDown, APartThatALaterStepTakesUpAgainIsNotFixed) {
  Scene scene = twoPins();
  scene.steps.push_back(scene.steps[0]);
  const PutDown put[] = {{1, Pose::translation({1, 0, 0})}, {2, Pose::translation({2, 0, 0})}};
  const Scene rest = sceneFromStep(scene, 2, put);
  EXPECT_FALSE(rest.parts[1].is_fixed);
  EXPECT_TRUE(rest.parts[2].is_fixed);
}

TEST(PutDown, PartsThatStartAtOnePlaceAreLaidOutSideBySide) {
  Scene scene = twoPins();
  scene.steps[1].X_WP_start = scene.steps[0].X_WP_start;
  const std::vector<Pose> X_WP = laidOut(scene);
  std::vector<Box> boxes_W;
  for (std::size_t i = 0; i < 3; ++i) boxes_W.push_back(moved(bounds(scene.parts[i].part.mesh), X_WP[i]));
  EXPECT_FALSE(overlap(boxes_W[1], boxes_W[2]));
  EXPECT_EQ(X_WP[1].p, scene.steps[0].X_WP_start.p) << "the first stays where it is";
  EXPECT_EQ(X_WP[2].p.z(), scene.steps[1].X_WP_start.p.z()) << "along x only";
}

TEST(PutDown, APartTakenFreelyGoesWhereTheHandGoesAndNeverEndsByItself) {
  const Scene scene = twoPins();
  std::vector<Pose> X_WP = laidOut(scene);
  X_WP[2] = scene.steps[1].X_WP_target;  // the part lies at its target, which does not end this step
  Scene free = sceneOfOnePart(scene, X_WP, 2);
  EXPECT_TRUE(free.parts[1].is_fixed);
  EXPECT_FALSE(free.parts[2].is_fixed);
  free.device.kind = "mouse";
  std::atomic<bool> stop = false;
  AssembleOptions options;
  options.is_real_time = true;
  options.stop = &stop;
  options.wish = std::make_shared<device::HandleWish>();
  // The handle rests for longer than the time that ends a step of a procedure, then moves 1 mm up and 1 mm
  // sideways; then the run is stopped.
  options.after_step = [&](double time_s) {
    if (time_s > 1) options.wish->write(Pose::translation({1e-3, 0, 1e-3}));
    if (time_s > 2) stop = true;
  };
  const AssembleResult result = assemble(free, options);
  EXPECT_GT(result.simulated_s, 2);
  const Vec3 way_m = result.trace.back().X_WP.p - X_WP[2].p;
  // The handle is at the requested pose, and the coupling carries 63 ug, which stretches it by far less than
  // a micrometre.
  EXPECT_LT((way_m - Vec3(1e-3, 0, 1e-3)).norm(), 20e-6) << way_m.transpose();
}

}  // namespace
}  // namespace vps::scenes
