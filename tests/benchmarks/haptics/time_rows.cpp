// SPDX-License-Identifier: BSD-3-Clause
// Rows about wall time, which depend on the machine and its load.
#include <sys/resource.h>

#include <cmath>
#include <string>

#include "rows.h"
#include "vps/pointshell.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/scene/scene.h"

namespace vps::bench {

namespace {

scenes::Scene shipped(const std::string& name) {
  return scenes::loadScene(std::string(VPS_SCENE_FOLDER) + "/" + name + "/scene.toml");
}

std::size_t pointsAt(double spacing_m, const Mesh& mesh) {
  PointShellSettings settings;
  settings.spacing_m = spacing_m;
  return buildPointShell(mesh, settings).size();
}

/// The coarsest spacing, to 1 %, that gives a part at least this many points.
double spacingFor(const Mesh& mesh, std::size_t points) {
  double spacing_m = std::sqrt(area(mesh) / static_cast<double>(points));
  while (pointsAt(spacing_m, mesh) < points) spacing_m *= 0.99;
  while (pointsAt(spacing_m / 0.99, mesh) >= points) spacing_m /= 0.99;
  return spacing_m;
}

double mostMemory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

void tickRow(const HapticOptions& options, Table& table) {
  for (const std::string name : {"peg_in_hole", "bearing_block"}) {
    if (options.is_short && name != "peg_in_hole") continue;
    scenes::Scene scene = shipped(name);
    scenes::AssembleOptions run;
    run.is_real_time = true;
    const scenes::AssembleResult result = scenes::assemble(scene, run);
    Row row{"haptic tick in real time, " + name,
            text("%.0f Hz", result.haptic_rate_hz),
            {atMost("p99", 1e-6 * result.haptic.p99_us, 250e-6, 1e6, "us"),
             reported("p50", 1e-6 * result.haptic.p50_us, 1e6, "us"),
             reported("longest", 1e-6 * result.haptic.max_us, 1e6, "us"),
             reported("missed", static_cast<double>(result.haptic.missed), 1, ""),
             reported("of", static_cast<double>(result.haptic.count), 1, "")},
            ""};
    for (const auto& [cause, count] : result.real_time->missed_by)
      if (count > 0)
        row.note += text("missed by %s: %llu; ", cause.c_str(), static_cast<unsigned long long>(count));
    table.add(row);
  }
}

void pointsRow(const HapticOptions& options, Table& table) {
  constexpr std::size_t kPaperPoints = 185'030;
  constexpr double kPaperRate_hz = 1600, kPaperMemory_bytes = 2e9;
  if (options.is_short) return;
  scenes::Scene scene = shipped("peg_in_hole");
  const scenes::ScenePart& held = scene.parts[scene.steps.front().part];
  scene.fidelity.spacing_m = spacingFor(held.part.mesh, kPaperPoints);
  const std::size_t points = pointsAt(scene.fidelity.spacing_m, held.part.mesh);
  scene.fidelity.physics_rate_hz = scene.fidelity.haptic_rate_hz = kPaperRate_hz;
  scene.fidelity.sides = Sides::One;  // only the points of the part in hand, as in the paper
  const scenes::AssembleResult result = scenes::assemble(scene);
  table.add({"physics step, query of 185,030 points",
             text("%.0f Hz", kPaperRate_hz),
             {holds(text("%zu points in hand", points), points >= kPaperPoints),
              atMost("p99", 1e-6 * result.physics.p99_us, 1 / kPaperRate_hz, 1e6, "us"),
              reported("p50", 1e-6 * result.physics.p50_us, 1e6, "us"),
              reported("longest", 1e-6 * result.physics.max_us, 1e6, "us"),
              reported("missed", static_cast<double>(result.physics.missed), 1, ""),
              reported("of", static_cast<double>(result.physics.count), 1, ""),
              atMost("memory of the whole program", mostMemory_bytes(), kPaperMemory_bytes, 1e-9, "GB"),
              holds("mounted", result.completed)},
             "the peg in its hole: all of its side is within the clearance of 50 um"});
}

}  // namespace vps::bench
