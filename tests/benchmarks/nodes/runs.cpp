// SPDX-License-Identifier: BSD-3-Clause
// A scene in real time, in three processes and in one.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "rows.h"
#include "support/process/node_processes.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

using nlohmann::json;

// Two runs in real time are never equal to the bit, so "as in one process" needs a tolerance. assumed: the
// greatest difference that was seen between two runs of one program, a factor of two; for depths the error of
// a part's mesh; and one missed period in 1000, which a scheduler causes.
constexpr double kFactor = 2, kDepth_m = 2e-6, kMissedShare = 1e-3;

double deepest_m(const json& run) {
  double deepest = 0;
  for (const json& step : run["steps"]) deepest = std::max(deepest, step["max_penetration_m"].get<double>());
  return deepest;
}
double missedShare(const json& run) {
  return run["wall"]["haptic"]["missed"].get<double>() / std::max(1.0, run["haptic"]["ticks"].get<double>());
}
bool hasSameVerdicts(const json& a, const json& b) {
  if (a["verdict"] != b["verdict"] || a["steps"].size() != b["steps"].size()) return false;
  for (std::size_t i = 0; i < a["steps"].size(); ++i)
    if (a["steps"][i]["verdict"] != b["steps"][i]["verdict"]) return false;
  return true;
}

std::string summary(const json& run) {
  const auto fits = std::count_if(run["steps"].begin(), run["steps"].end(),
                                  [](const json& step) { return step["verdict"] == "fits"; });
  char words[200];
  std::snprintf(
      words, sizeof words, "%s, %ld of %zu steps fit, deepest %.2f um, haptic periods missed %ld of %ld",
      run["verdict"].get<std::string>().c_str(), static_cast<long>(fits), run["steps"].size(),
      1e6 * deepest_m(run), run["wall"]["haptic"]["missed"].get<long>(), run["haptic"]["ticks"].get<long>());
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
  const bool has_same = status == 0 && hasSameVerdicts(three, one);
  const bool is_as_deep = deepest_m(three) <= kFactor * deepest_m(one) + kDepth_m;
  const bool is_as_punctual = missedShare(three) <= kFactor * missedShare(one) + kMissedShare;
  const bool is_reached = has_same && is_as_deep && is_as_punctual;
  std::string departs = summary(three);
  if (!has_same) departs += "; another verdict, of the whole or of a step";
  if (!is_as_deep) departs += "; deeper than in one process";
  if (!is_as_punctual) departs += "; misses more periods than one process";
  printRow("three processes: " + three["scene"].get<std::string>(),
           "verdicts of all steps as in one process; depth and share of misses at most twice its", departs,
           is_reached);
  printRow("one process", "", summary(one), true);
  return is_reached;
}

}  // namespace vps::bench
