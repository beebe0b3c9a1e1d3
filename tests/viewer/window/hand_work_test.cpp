// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_work.h"

#include <gtest/gtest.h>

#include "scenes/two_pins.h"
#include "view/procedure_view.h"

namespace vps::viewer {
namespace {

scenes::PutDown put(std::size_t part, double x_m) {
  return {part, Pose::translation(Vec3(x_m, 0, 0))};
}
scenes::StepResult good(const std::string& part) {
  scenes::StepResult result;
  result.part = part;
  result.completed = true;
  result.verdict = scenes::Verdict::Fits;
  return result;
}

TEST(HandWork, UndoLeavesWhatWasBeforeAndRedoWhatWasThere) {
  const scenes::Scene scene = scenes::twoPins();
  HandWork work(scene);
  EXPECT_FALSE(work.undo());
  work.putDown(put(1, -0.0051), good("left"));
  const scenes::Snapshot before = work.snapshot();
  work.putDown(put(2, 0.0049), good("right"));
  EXPECT_TRUE(work.isOver());
  ASSERT_TRUE(work.undo());
  EXPECT_EQ(work.nextStep(), 1u);
  const scenes::Snapshot undone = work.snapshot();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(undone.bodies[i].X_WP.p, before.bodies[i].X_WP.p) << i;
    EXPECT_EQ(undone.bodies[i].role, before.bodies[i].role) << i;
  }
  const scenes::Scene rest = work.sceneToRun();
  ASSERT_EQ(rest.steps.size(), 1u);
  EXPECT_EQ(rest.steps[0].part, 2u);
  EXPECT_TRUE(rest.parts[1].is_fixed);
  EXPECT_EQ(rest.parts[1].X_WP.p.x(), -0.0051);
  ASSERT_TRUE(work.redo());
  EXPECT_EQ(work.snapshot().bodies[2].X_WP.p.x(), 0.0049);
  EXPECT_EQ(work.results().size(), 2u);
  EXPECT_FALSE(work.redo());
}

TEST(HandWork, WhatIsDoneAnewCannotBeRedone) {
  const scenes::Scene scene = scenes::twoPins();
  HandWork work(scene);
  work.putDown(put(1, 0));
  work.undo();
  work.putDown(put(1, 1));
  EXPECT_FALSE(work.redo());
}

TEST(HandWork, FreelyAnyPartIsTakenFromWhereItLies) {
  const scenes::Scene scene = scenes::twoPins();
  HandWork work(scene);
  work.begin(true);
  for (const scenes::BodySnapshot& body : work.snapshot().bodies)
    EXPECT_EQ(body.role, scenes::BodyRole::Mounted);
  work.putDown(put(2, 0.03));
  const scenes::Scene again = work.sceneToRun(2);
  ASSERT_EQ(again.steps.size(), 1u);
  EXPECT_EQ(again.steps[0].X_WP_start.p.x(), 0.03);
  EXPECT_EQ(again.steps[0].X_WP_target.p, scene.steps[1].X_WP_target.p) << "a hint";
  EXPECT_FALSE(work.isOver());
  work.undo();
  EXPECT_EQ(work.sceneToRun(2).steps[0].X_WP_start.p, scenes::laidOut(scene)[2].p);
}

TEST(HandWork, TheVerdictOfWhatWasGoneOnWithIsThatOfAllSteps) {
  scenes::AssembleResult rest;
  rest.steps = {good("right")};
  rest.verdict = scenes::Verdict::Fits;
  rest.completed = true;
  scenes::AssembleResult bad = rest;
  addEarlierSteps({good("left")}, 2, rest);
  EXPECT_EQ(rest.steps.size(), 2u);
  EXPECT_EQ(rest.verdict, scenes::Verdict::Fits);
  scenes::StepResult failed = good("left");
  failed.verdict = scenes::Verdict::NotShown;
  failed.completed = false;
  addEarlierSteps({failed}, 2, bad);
  EXPECT_EQ(bad.verdict, scenes::Verdict::NotShown);
  EXPECT_FALSE(bad.completed);
}

TEST(PlannedPath, GoesFromStartByTheWayPointsToTheTarget) {
  scenes::Scene scene = scenes::twoPins();
  scene.steps[1].way_points = {Pose::translation(Vec3(0.02, 0, 0.01))};
  scenes::Snapshot shot;
  EXPECT_TRUE(plannedPath(scene, shot).points_W.empty());
  shot.step = 1;
  const PlannedPath path = plannedPath(scene, shot);
  ASSERT_EQ(path.points_W.size(), 3u);  // the path is that of the pin's centre of mass, which is its origin
  EXPECT_LT((path.points_W[0] - scene.steps[1].X_WP_start.p).norm(), 1e-15);
  EXPECT_LT((path.points_W[1] - Vec3(0.02, 0, 0.01)).norm(), 1e-15);
  EXPECT_LT((path.points_W[2] - scene.steps[1].X_WP_target.p).norm(), 1e-15);
  EXPECT_LT((path.axis_W - (path.points_W[2] - path.points_W[1]).normalized()).norm(), 1e-12);
}

}  // namespace
}  // namespace vps::viewer
