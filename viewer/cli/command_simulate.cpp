// SPDX-License-Identifier: BSD-3-Clause
// vps simulate: the scene's bodies under gravity, no hand.
#include <cmath>
#include <cstdio>

#include "commands.h"
#include "json_out.h"
#include "output.h"
#include "progress_bar.h"
#include "table.h"
#include "terminal.h"
#include "vps/load_error.h"
#include "vps_scenes/simulate.h"
#include "vps_viewer/csv.h"

namespace vps::viewer {

namespace {

std::string traceHead(const std::vector<scenes::BodyState>& bodies) {
  std::vector<std::string> cells = {"time_s", "max_depth_m"};
  for (const scenes::BodyState& body : bodies)
    for (const char* column : {".x_m", ".y_m", ".z_m", ".qx", ".qy", ".qz", ".qw"})
      cells.push_back(body.name + column);
  return csvLine(cells);
}

std::string traceRow(double time_s, const std::vector<scenes::BodyState>& bodies, double max_depth_m) {
  std::vector<std::string> cells = {csvNumber(time_s), csvNumber(max_depth_m)};
  for (const scenes::BodyState& body : bodies) {
    const Vec3& p = body.X_WP.p;
    const Quat q = body.X_WP.quaternion();
    for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()})
      cells.push_back(csvNumber(value));
  }
  return csvLine(cells);
}

}  // namespace

int runSimulate(const SimulateArguments& given) {
  if (!std::isfinite(given.seconds) || given.seconds <= 0)
    throw LoadError("", "", "--seconds must be a finite number of more than 0");
  OutputFile trace(given.trace, {given.scene}), json(given.json, {given.scene});
  ProgressBar bar;
  scenes::Scene scene = sceneFrom(given.scene, given.fidelity, {given.trace, given.json});

  std::string rows;
  scenes::SimulateOptions options;
  const std::optional<VoxMapCache> cache = cacheFrom(given.cache);
  fill(options, bar, cache, given.models_everything);
  options.is_real_time = given.is_real_time;
  options.stop = &stopRequested();
  if (!given.trace.empty())
    options.trace = [&rows](double time_s, const std::vector<scenes::BodyState>& bodies, double max_depth_m) {
      if (rows.empty()) rows = traceHead(bodies);
      rows += traceRow(time_s, bodies, max_depth_m);
    };
  const scenes::SimulateResult result = scenes::simulate(scene, given.seconds, options);
  throwIfStopped();
  trace.write(rows);
  json.write(toJson(given.scene, given.seconds, result));
  bar.clear();

  Table table({"<body", "x [mm]", "y [mm]", "z [mm]", "speed [mm/s]", "spin [rad/s]"});
  for (const scenes::BodyState& body : result.bodies)
    table.add({body.name, fixed(body.X_WP.p.x() * 1e3, 4), fixed(body.X_WP.p.y() * 1e3, 4),
               fixed(body.X_WP.p.z() * 1e3, 4), fixed(body.V_WP_W.v.norm() * 1e3, 4),
               fixed(body.V_WP_W.w.norm(), 4)});
  std::fputs(table.text().c_str(), stdout);
  std::printf("deepest %s um, kinetic energy %.3g J; a step took %s us (median), %s us (longest)\n",
              fixed(result.max_penetration_m * 1e6, 2).c_str(), result.kinetic_energy_J,
              fixed(result.step.p50_us, 0).c_str(), fixed(result.step.max_us, 0).c_str());
  if (!result.real_time) return kGood;
  for (const std::string& words : result.real_time->warnings) warn(words);
  std::printf("by the clock: %s s for %s s; %llu of %llu periods missed\n",
              fixed(result.real_time->run_wall_s, 2).c_str(), fixed(given.seconds, 2).c_str(),
              static_cast<unsigned long long>(result.real_time->missed),
              static_cast<unsigned long long>(result.step.count + result.real_time->missed));
  return kGood;
}

}  // namespace vps::viewer
