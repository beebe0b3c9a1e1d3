// SPDX-License-Identifier: BSD-3-Clause
#include "view/timeline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "view/procedure_view.h"
#include "view/view_state.h"

namespace vps::viewer {
namespace {

/// A fixed plate and two pins that move down from 0.1 m above it; the second one passes a way point at its
/// side.
scenes::Scene twoPins() {
  scenes::Scene scene;
  for (const char* name : {"plate", "left", "right"}) {
    scenes::ScenePart part;
    part.part.name = name;
    part.part.mesh = makeBox(Vec3(0.02, 0.02, 0.02));
    scene.parts.push_back(part);
  }
  scene.parts[0].is_fixed = true;
  for (std::size_t i = 1; i < 3; ++i) {
    scenes::SceneStep step;
    step.part = i;
    step.X_WP_target = Pose::translation(Vec3(i == 1 ? -0.05 : 0.05, 0, 0));
    step.X_WP_start = Pose::translation(step.X_WP_target.p + Vec3(0, 0, 0.1));
    scene.steps.push_back(step);
  }
  scene.steps[1].way_points = {Pose::translation(Vec3(0.08, 0, 0.05))};
  return scene;
}

device::RunTrace row(double time_s, int step, double z_m, std::uint8_t phase, double force_N) {
  device::RunTrace row;
  row.time_s = time_s;
  row.step = step;
  row.X_WP = Pose::translation(Vec3(0, 0, z_m));
  row.phase = phase;
  row.F_hand_W.f = Vec3(0, 0, force_N);
  row.depth_m = 2e-6;
  row.contacts = 3;
  return row;
}

TEST(TimelineTest, TheTourShowsTheFinishedAssemblyFirstAndThenStepAfterStep) {
  const scenes::Scene scene = twoPins();
  const Timeline tour = sceneTour(scene);
  ASSERT_EQ(tour.chapters.size(), 3U);
  const scenes::Snapshot finished = tour.at(0);
  for (const scenes::BodySnapshot& body : finished.bodies) EXPECT_EQ(body.role, scenes::BodyRole::Mounted);
  EXPECT_FALSE(finished.has_target);

  const scenes::Snapshot first = tour.at(tour.chapters[1].start_s);
  EXPECT_EQ(first.step, 0);
  EXPECT_EQ(first.bodies[1].role, scenes::BodyRole::InHand);
  EXPECT_EQ(first.bodies[1].X_WP.p, scene.steps[0].X_WP_start.p);
  EXPECT_EQ(first.bodies[2].role, scenes::BodyRole::Waiting);
  EXPECT_TRUE(first.has_target);
  EXPECT_EQ(first.X_WP_target.p, scene.steps[0].X_WP_target.p);

  const scenes::Snapshot second = tour.at(tour.chapters[2].start_s);
  EXPECT_EQ(second.bodies[1].role, scenes::BodyRole::Mounted);
  EXPECT_EQ(second.bodies[1].X_WP.p, scene.steps[0].X_WP_target.p);
  // Half of a minimum-jerk motion over two legs is the way point between them.
  const double move_s = 1.5;
  EXPECT_NEAR((tour.at(tour.chapters[2].start_s + move_s / 2).bodies[2].X_WP.p - Vec3(0.08, 0, 0.05)).norm(),
              0, 1e-12);
  EXPECT_NEAR((tour.at(1e9).bodies[2].X_WP.p - scene.steps[1].X_WP_target.p).norm(), 0, 1e-15);
}

TEST(TimelineTest, ARecordingShowsThePartsWhereItsTraceHasThem) {
  const scenes::Scene scene = twoPins();
  device::RunEvent note;
  note.time_s = 0.2;
  note.setWords("takes 'left'");
  device::RecordedRun run;
  run.entries = {row(0.1, 0, 0.09, 0, 1), note, row(0.3, 0, 0.02, 3, 0), row(0.5, 1, 0.07, 1, 4)};
  const Timeline line = recordedTimeline(scene, run);
  ASSERT_EQ(line.chapters.size(), 2U);
  EXPECT_EQ(line.chapters[1].start_s, 0.5);
  EXPECT_EQ(line.end_s, 0.5);
  EXPECT_EQ(line.chapterAt(0.49), 0U);
  EXPECT_EQ(line.chapterAt(0.5), 1U);

  EXPECT_EQ(line.at(0).bodies[1].X_WP.p.z(), 0.09)
      << "before the first row the pose is that of the first row";
  EXPECT_EQ(line.at(0.35).bodies[1].role, scenes::BodyRole::Released);
  const scenes::Snapshot end = line.at(0.5);
  EXPECT_EQ(end.bodies[0].role, scenes::BodyRole::Mounted);
  EXPECT_EQ(end.bodies[1].role, scenes::BodyRole::Mounted);
  EXPECT_EQ(end.bodies[1].X_WP.p.z(), 0.02);
  EXPECT_EQ(end.bodies[2].role, scenes::BodyRole::InHand);
  EXPECT_EQ(end.F_hand_W.f.z(), 4);

  ASSERT_EQ(line.curves.size(), 4U);
  EXPECT_EQ(line.curves[0].values, (std::vector<float>{1, 0, 4}));
  EXPECT_EQ(line.curves[2].values, (std::vector<float>{2, 2, 2})) << "micrometres";
  ASSERT_EQ(line.messages.size(), 1U);
  EXPECT_EQ(line.messages[0].words, "takes 'left'");
}

TEST(TimelineTest, ARecordingWithoutOrWithStrangeRowsIsShownAsFarAsItGoes) {
  const scenes::Scene scene = twoPins();
  device::RecordedRun run;
  EXPECT_EQ(recordedTimeline(scene, run).at(1).bodies.size(), 3U);
  device::RunTrace broken = row(0.2, 0, 0, 0, 0);
  broken.X_WP.p.x() = std::nan("");
  run.entries = {row(0.1, 7, 0, 0, 0), row(0.1, -1, 0, 0, 0), broken, row(0.3, 0, 0.05, 0, 0),
                 row(0.2, 0, 0.04, 0, 0)};
  const Timeline line = recordedTimeline(scene, run);
  EXPECT_EQ(line.time_s, std::vector<double>{0.3});
}

TEST(ExplodedTest, PartsMoveBackAlongTheirLastLegAndLaterOnesFarther) {
  const scenes::Scene scene = twoPins();
  const scenes::Snapshot whole = sceneTour(scene).at(0);
  const scenes::Snapshot apart = exploded(scene, whole, 0.5, 0.2);
  EXPECT_EQ(apart.bodies[0].X_WP.p, whole.bodies[0].X_WP.p) << "fixed";
  // Half of the size, times one half for the first of two steps: 0.05 m up.
  EXPECT_NEAR((apart.bodies[1].X_WP.p - whole.bodies[1].X_WP.p - Vec3(0, 0, 0.05)).norm(), 0, 1e-15);
  const Vec3 way = apart.bodies[2].X_WP.p - whole.bodies[2].X_WP.p;
  EXPECT_NEAR(way.norm(), 0.1, 1e-15);
  EXPECT_NEAR((way.normalized() - Vec3(0.03, 0, 0.05).normalized()).norm(), 0, 1e-12);
  EXPECT_EQ(exploded(scene, whole, 0, 0.2).bodies[2].X_WP.p, whole.bodies[2].X_WP.p);
}

TEST(ViewStateTest, KeysPlayAndMoveAlongTheSteps) {
  const scenes::Scene scene = twoPins();
  const Timeline tour = sceneTour(scene);
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  ViewState view;
  apply(Action::NextStep, view, tour, box);
  EXPECT_EQ(view.time_s, tour.chapters[1].start_s);
  apply(Action::Forward, view, tour, box);
  apply(Action::Forward, view, tour, box);
  apply(Action::LastStep, view, tour, box);
  EXPECT_EQ(view.time_s, tour.chapters[1].start_s) << "the key goes to the start of the same step";
  apply(Action::LastStep, view, tour, box);
  EXPECT_EQ(view.time_s, 0);
  apply(Action::PlayPause, view, tour, box);
  advance(view, tour, 0.25);
  EXPECT_EQ(view.time_s, 0.25);
  advance(view, tour, 1000);
  EXPECT_EQ(view.time_s, tour.end_s);
  EXPECT_FALSE(view.is_playing);
  apply(Action::PlayPause, view, tour, box);
  EXPECT_EQ(view.time_s, 0) << "playing from the end begins again";
}

TEST(ViewStateTest, WhatIsShownAloneStaysSoInEachStereoMode) {
  const Timeline line = sceneTour(scenes::Scene{});
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  ViewState view;
  view.outputs = 3;
  view.output = 2;
  for (const std::size_t eye : {0, 1}) {
    while (view.stereo != StereoMode::Spectral) {
      EXPECT_EQ(view.output, 2U) << toText(view.stereo);
      apply(Action::Stereo, view, line, box);
    }
    EXPECT_EQ(view.output, 4U) << "the left eye of the selected output";
    *view.output += eye;
    apply(Action::Stereo, view, line, box);
    EXPECT_EQ(view.output, 2U);
  }
}

TEST(ViewStateTest, EachKeyIsBoundOnceAndEveryActionSurvives) {
  const scenes::Scene scene = twoPins();
  const Timeline tour = sceneTour(scene);
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  std::vector<std::string> keys;
  for (const KeyBinding& binding : keyBindings()) {
    EXPECT_EQ(std::count(keys.begin(), keys.end(), binding.key), 0) << binding.key;
    keys.push_back(binding.key);
    ViewState view;
    apply(binding.action, view, tour, box);
    apply(binding.action, view, tour, box);
    EXPECT_TRUE(view.camera.eye_W.allFinite()) << binding.key;
  }
}

TEST(ViewStateTest, TheSectionKeyCutsAcrossTheView) {
  const Timeline line = sceneTour(scenes::Scene{});
  ViewState view;
  view.camera.eye_W = Vec3(0.1, -3, 0.2);
  const Box box{Vec3(-1, -1, -1), Vec3(1, 1, 3)};
  apply(Action::Section, view, line, box);
  ASSERT_TRUE(view.draw.cut);
  EXPECT_EQ(view.draw.cut->n_W, Vec3(0, -1, 0));
  EXPECT_EQ(view.draw.cut->p_W, Vec3(0, 0, 1));
  apply(Action::FlipSection, view, line, box);
  EXPECT_EQ(view.draw.cut->n_W, Vec3(0, 1, 0));
  apply(Action::Section, view, line, box);
  EXPECT_FALSE(view.draw.cut);
}

TEST(LiveCurves, HaveAValueForEachInstantAndNoneWhereNothingIsKnown) {
  Timeline line;
  line.curves = liveCurves();
  scenes::Snapshot shot;
  shot.time_s = 0.5;
  shot.has_hand = true;
  shot.F_hand_W.f = Vec3(3, 0, 4);
  shot.F_hand_W.tau = Vec3(0, 0.2, 0);
  shot.contacts = {{Vec3::Zero(), Vec3::UnitZ(), 2e-6}, {Vec3::Zero(), Vec3::UnitZ(), 7e-6}};
  addInstant(line, shot, {});
  shot.time_s = 0.6;
  shot.figures = scenes::RunFigures{.injected_J = 3e-6};
  addInstant(line, shot, 12e-6);
  EXPECT_EQ(line.time_s, (std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(line.end_s, 0.6);
  const auto valuesOf = [&](const std::string& name) {
    for (const Curve& curve : line.curves)
      if (curve.name == name) return curve.values;
    ADD_FAILURE() << name;
    return std::vector<float>(2);
  };
  EXPECT_EQ(valuesOf("force")[0], 5.0f);
  EXPECT_EQ(valuesOf("torque")[0], 0.2f);
  EXPECT_FLOAT_EQ(valuesOf("depth")[0], 7.0f);
  EXPECT_EQ(valuesOf("contacts")[0], 2.0f);
  EXPECT_TRUE(std::isnan(valuesOf("clearance")[0]));
  EXPECT_TRUE(std::isnan(valuesOf("energy injected")[0]));
  EXPECT_FLOAT_EQ(valuesOf("clearance")[1], 12.0f);
  EXPECT_FLOAT_EQ(valuesOf("energy injected")[1], 3e-3f);
}

TEST(LiveChapters, WhoJoinsAtTheThirdStepGetsAChapterForEachOnce) {
  Timeline line;
  line.chapters = {{"before the first step", 0, ""}};
  const auto name = [](std::size_t step) { return std::to_string(step + 1); };
  for (const double time_s : {7.0, 7.1, 7.2}) addChapters(line, 2, time_s, name);
  addChapters(line, 3, 9, name);
  ASSERT_EQ(line.chapters.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(line.chapters[i].name, std::to_string(i));
    EXPECT_EQ(line.chapters[i].start_s, i < 4 ? 7 : 9);
  }
  EXPECT_EQ(line.chapterAt(8), 3u) << "the current step";
}

TEST(LiveCurves, RatesAreThoseSinceTheFiguresBefore) {
  const scenes::RunFigures before = {.ticks = 1000, .physics_steps = 500};
  const scenes::RunFigures now = {.ticks = 5000,
                                  .missed = 3,
                                  .physics_steps = 2500,
                                  .physics_missed = 1,
                                  .tick_p99_us = 41,
                                  .step_p99_us = 600,
                                  .to_hand_J = 2e-3,
                                  .injected_J = 5e-6};
  const std::vector<std::string> lines = figureLines(now, before, 2);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0], "haptic ticks: 2000 a second, p99 41 µs, 3 missed");
  EXPECT_EQ(lines[1], "physics steps: 1000 a second, p99 600 µs, 1 missed");
  EXPECT_EQ(lines[2], "energy: 2 mJ to the hand, 0 from it");
  EXPECT_EQ(lines[3], "energy injected: 0.005 mJ");
}

}  // namespace
}  // namespace vps::viewer
