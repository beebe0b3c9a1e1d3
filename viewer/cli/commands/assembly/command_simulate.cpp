// SPDX-License-Identifier: BSD-3-Clause
// vps simulate: moves the bodies of a scene under gravity, without an operator.
#include <cmath>
#include <cstdio>
#include <memory>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_scenes/run/simulate.h"
#include "vps_viewer/report/csv.h"

namespace vps::viewer {

namespace {

struct SimulateArguments {
  SceneArguments scene;
  double seconds = 1;
  bool is_real_time = false;
  int judge_every = 0;
  std::string trace, json;
};

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

/// Prints the overlaps by exact distance. Returns false if an overlap exceeds the scene's limit.
bool printOverlap(const scenes::JudgedOverlap& judged) {
  const auto um = [](double length_m) { return fixed(length_m * 1e6, 2); };
  for (const auto& [start, apart_s, end_depth_m] : judged.at_start)
    warn("'" + start.a + "' starts " + um(start.depth_m) + " um inside '" + start.b + "'; " +
         (apart_s ? "these parts were apart after " + fixed(*apart_s, 3) + " s"
                  : "these parts did not come apart, and end " + um(end_depth_m) + " um inside each other"));
  const scenes::PairOverlap& deepest = judged.deepest;
  std::printf("deepest overlap by exact distance %s um (limit %s um)", um(deepest.depth_m).c_str(),
              um(judged.limit_m).c_str());
  if (deepest.depth_m > 0)
    std::printf(", '%s' in '%s' at %s s", deepest.a.c_str(), deepest.b.c_str(),
                fixed(deepest.time_s, 4).c_str());
  std::printf("; overlap measured at %zu instants\n", judged.poses_judged);
  if (judged.neverApart() > 0)
    std::printf("not within the limit: %zu %s overlapped from start to end\n", judged.neverApart(),
                judged.neverApart() == 1 ? "pair of bodies" : "pairs of bodies");
  return judged.isWithinLimit();
}

/// Describes the deepest overlap of the run, and its upper bound at any time.
std::string depthInWords(const scenes::SimulateResult& result) {
  const auto um = [](double length_m) { return fixed(length_m * 1e6, 2) + " um"; };
  const scenes::PairOverlap& deepest = result.exact.deepest;
  const std::string which = deepest.depth_m > 0 ? ", '" + deepest.a + "' in '" + deepest.b + "' at " +
                                                      fixed(deepest.time_s, 4) + " s"
                                                : "";
  const std::string found = "deepest overlap " + um(deepest.depth_m) + " by exact distance" + which;
  const std::string bound = um(result.exact.bound_m);
  if (!result.exact.is_searched) return found + "; the search was not completed: at most " + bound;
  if (result.exact.bound_m <= 2e-6 + 1.05 * deepest.depth_m) return found + ", at no time more than " + bound;
  return found + "; parts that overlap at the start may be deeper for a moment, by at most " + bound +
         " in all";
}

int runSimulate(const SimulateArguments& given) {
  if (!std::isfinite(given.seconds) || given.seconds <= 0)
    throw LoadError("", "", "--seconds must be a finite number greater than 0");
  const std::string& file = given.scene.scene;
  OutputFile trace(given.trace, {file}), json(given.json, {file});
  ProgressBar bar;
  scenes::Scene scene = sceneFrom(file, given.scene.fidelity, {given.trace, given.json}, given.scene.cache);

  std::string rows;
  scenes::SimulateOptions options;
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache);
  setModelOptions(options, bar, cache, given.scene.models_everything);
  options.is_real_time = given.is_real_time;
  options.judge_every = given.judge_every;
  options.stop = &stopRequested();
  if (!given.trace.empty())
    options.trace = [&rows](double time_s, const std::vector<scenes::BodyState>& bodies, double max_depth_m) {
      if (rows.empty()) rows = traceHead(bodies);
      rows += traceRow(time_s, bodies, max_depth_m);
    };
  const scenes::SimulateResult result = scenes::simulate(scene, given.seconds, options);
  throwIfStopped();
  trace.write(rows);
  json.write(toJson(file, given.seconds, result));
  bar.clear();

  Table table({"<body", "x [mm]", "y [mm]", "z [mm]", "speed [mm/s]", "spin [rad/s]"});
  for (const scenes::BodyState& body : result.bodies)
    table.add({body.name, fixed(body.X_WP.p.x() * 1e3, 4), fixed(body.X_WP.p.y() * 1e3, 4),
               fixed(body.X_WP.p.z() * 1e3, 4), fixed(body.V_WP_W.v.norm() * 1e3, 4),
               fixed(body.V_WP_W.w.norm(), 4)});
  std::fputs(table.text().c_str(), stdout);
  std::printf("%s\nkinetic energy %.3g J; time per step %s us (median), %s us (longest)\n",
              depthInWords(result).c_str(), result.kinetic_energy_J, fixed(result.step.p50_us, 0).c_str(),
              fixed(result.step.max_us, 0).c_str());
  if (result.shortened_steps > 0)
    std::printf(
        "steps shortened: bodies in contact were stopped within a step %zu times, which removes energy\n",
        result.shortened_steps);
  if (!result.fast_turns.empty()) warn(inWords(result.fast_turns, scene.fidelity));
  const bool is_good = !result.overlap || printOverlap(*result.overlap);
  if (!result.real_time) return is_good ? kGood : kBad;
  for (const std::string& words : result.real_time->warnings) warn(words);
  std::printf("real time: %s s of simulated time took %s s; %llu of %llu periods missed\n",
              fixed(given.seconds, 2).c_str(), fixed(result.real_time->run_wall_s, 2).c_str(),
              static_cast<unsigned long long>(result.real_time->missed),
              static_cast<unsigned long long>(result.step.count + result.real_time->missed));
  return kGood;
}

}  // namespace

std::function<int()> addSimulate(CLI::App& command) {
  const auto given = std::make_shared<SimulateArguments>();
  addSceneOptions(command, given->scene);
  command.add_option("--seconds", given->seconds, "simulated time")->capture_default_str()->type_name("S");
  command
      .add_option(
          "--judge-every", given->judge_every,
          "measure the overlap of all bodies after every so many steps, and search the steps between them "
          "ten times as long as without this option; exit status 1 if an overlap exceeds the scene's limit")
      ->type_name("STEPS")
      ->check(CLI::PositiveNumber);
  command.add_flag("--real-time", given->is_real_time,
                   "start each step when it is due in real time, and count missed periods");
  command.add_option("--trace", given->trace, "CSV file with a row for each step")->type_name("FILE");
  addJsonOption(command, given->json);
  return [given] { return runSimulate(*given); };
}

}  // namespace vps::viewer
