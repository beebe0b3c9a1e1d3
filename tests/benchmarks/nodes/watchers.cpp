// SPDX-License-Identifier: BSD-3-Clause
// The cost of ten watchers to the haptic loop: nine in terminals, and one that serves the page.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rows.h"
#include "support/process/node_processes.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

struct Missed {
  long missed = 0, ticks = 0;
  double p999_us = 0;  ///< greatest p99.9 of the loop's computing time
  bool is_whole = true;
};

void addRun(const std::string& scene, int watchers, Missed& sum) {
  const test::TemporaryFolder folder;
  const std::string session = "bench-watchers-" + std::to_string(getpid());
  test::NodeProcesses nodes(VPS_PROGRAM, scene, session, folder.path());
  std::vector<test::ChildProcess> all;
  for (int i = 0; i < watchers; ++i) {
    std::vector<std::string> words = {VPS_PROGRAM, "watch", "--terminal", "--session", session};
    if (i == 0) words.insert(words.end(), {"--web", "0"});
    all.emplace_back(std::move(words), (folder.path() / ("watch" + std::to_string(i) + ".txt")).string());
  }
  nodes.startDevice();
  nodes.startRender();
  nodes.render.wait();
  std::ifstream in(folder.path() / "run.json");
  const nlohmann::json run = nlohmann::json::parse(in, nullptr, false);
  if (run.is_discarded()) {
    sum.is_whole = false;
    return;
  }
  sum.missed += run["wall"]["haptic"]["missed"].get<long>();
  sum.ticks += run["haptic"]["ticks"].get<long>();
  sum.p999_us = std::max(sum.p999_us, run["wall"]["haptic"]["tick_us"]["p999"].get<double>());
}

}  // namespace

bool watcherRows(const std::string& scene) {
  constexpr int kRuns = 3, kWatchers = 10;
  Missed alone, watched;
  for (int i = 0; i < kRuns; ++i) {
    addRun(scene, 0, alone);
    addRun(scene, kWatchers, watched);
  }
  char words[240];
  std::snprintf(words, sizeof words,
                "%ld of %ld periods missed with ten, %ld of %ld without; p99.9 of a tick %.0f and %.0f us",
                watched.missed, watched.ticks, alone.missed, alone.ticks, watched.p999_us, alone.p999_us);
  const bool is_reached = alone.is_whole && watched.is_whole && watched.missed <= alone.missed;
  printRow("ten watchers, three runs each in turn: " + scene, "no tick more is missed than without", words,
           is_reached);
  return is_reached;
}

}  // namespace vps::bench
