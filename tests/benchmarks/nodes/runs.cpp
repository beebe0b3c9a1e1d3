// SPDX-License-Identifier: BSD-3-Clause
// A scene by the clock in three processes, and in one.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "rows.h"
#include "support/node_processes.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

using nlohmann::json;

std::string summary(const json& run) {
  double deepest_m = 0;
  for (const json& step : run["steps"])
    deepest_m = std::max(deepest_m, step["max_penetration_m"].get<double>());
  const auto fits = std::count_if(run["steps"].begin(), run["steps"].end(),
                                  [](const json& step) { return step["verdict"] == "fits"; });
  char words[200];
  std::snprintf(
      words, sizeof words, "%s, %ld of %zu steps fit, deepest %.2f um, haptic periods missed %ld of %ld",
      run["verdict"].get<std::string>().c_str(), static_cast<long>(fits), run["steps"].size(),
      1e6 * deepest_m, run["wall"]["haptic"]["missed"].get<long>(), run["haptic"]["ticks"].get<long>());
  return words;
}

json readRun(const std::filesystem::path& file) {
  std::ifstream in(file);
  return json::parse(in, nullptr, false);
}

}  // namespace

bool runRows(const std::string& scene) {
  const test::TemporaryFolder folder;
  test::NodeProcesses nodes(VPS_PROGRAM, scene, "bench-" + std::to_string(getpid()), folder.path());
  nodes.startWatch();
  nodes.startDevice();
  nodes.startRender();
  const int status = nodes.render.wait();
  const json three = readRun(folder.path() / "run.json");
  nodes.device.killNow();
  test::ChildProcess alone(
      {VPS_PROGRAM, "assemble", scene, "--real-time", "--no-pictures", "--out",
       (folder.path() / "one").string(), "--json", (folder.path() / "one.json").string()},
      (folder.path() / "one.txt").string());
  alone.wait();
  const json one = readRun(folder.path() / "one.json");
  if (three.is_discarded() || one.is_discarded()) {
    printRow("three processes: " + scene, "as in one process", "a run gave no result", false);
    return false;
  }
  const bool is_reached = status == 0 && three["verdict"] == one["verdict"];
  printRow("three processes: " + three["scene"].get<std::string>(), "as in one process", summary(three),
           is_reached);
  printRow("one process", "", summary(one), true);
  return is_reached;
}

}  // namespace vps::bench
