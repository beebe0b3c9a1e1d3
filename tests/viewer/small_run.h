// SPDX-License-Identifier: BSD-3-Clause
// A made-up run of one peg and one hole, for tests of reports.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::viewer::test {

inline std::string freshFolder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "vps_report_test" / name;
  std::filesystem::remove_all(folder);
  return folder.string();
}

inline std::string textOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The trace of one second: two taps of 5 ms, then contact over 10 mm of travel.
inline std::vector<scenes::TraceRow> tapTapSlide() {
  std::vector<scenes::TraceRow> trace;
  for (int i = 0; i < 1000; ++i) {
    scenes::TraceRow row;
    row.time_s = 1e-3 * i;
    row.step = 0;
    row.phase = i < 500 ? 1 : 2;
    const bool is_sliding = i >= 600 && i < 800;
    row.contacts = (i >= 100 && i < 105) || (i >= 300 && i < 305) || is_sliding ? 3 : 0;
    row.X_WP.p = Vec3(is_sliding ? 5e-5 * (i - 600) : 0, 0, 0);
    row.F_hand_W.f = Vec3(0, 0, row.contacts);
    row.depth_m = 1e-6 * row.contacts;
    trace.push_back(row);
  }
  return trace;
}

inline scenes::Scene smallScene() {
  scenes::Scene scene;
  scene.name = "peg & <hole>";
  scene.parts.resize(2);
  scene.parts[0].part.name = "hole";
  scene.parts[0].part.mesh = makeTube(0.02, 0.0101, 0.03, 32);
  scene.parts[0].is_fixed = true;
  scene.parts[1].part.name = "peg <1>";
  scene.parts[1].part.mesh = makeCylinder(0.01, 0.03, 32);
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_start = Pose::translation(Vec3(0, 0, 0.05));
  return scene;
}

inline scenes::AssembleResult smallResult() {
  scenes::AssembleResult result;
  result.scene = "peg & <hole>";
  scenes::StepResult step;
  step.part = "peg <1>";
  step.reason = step.failure_reason = "stuck at \"3 mm\" & <up>";
  step.penetration_limit_m = 10e-6;
  step.max_penetration_m = 12.5e-6;
  result.steps = {step};
  result.trace = tapTapSlide();
  scenes::Snapshot snapshot;
  snapshot.step = 0;
  snapshot.bodies = {{1, Pose::translation(Vec3(0, 0, 0.02)), scenes::BodyRole::InHand}};
  result.start = result.contact = result.end = {snapshot};
  result.finished = snapshot;
  return result;
}

}  // namespace vps::viewer::test
