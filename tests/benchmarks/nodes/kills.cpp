// SPDX-License-Identifier: BSD-3-Clause
// kill -9 of each node in turn: when the device is safe, whether the session goes on, and what stays behind.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "rows.h"
#include "support/node_processes.h"
#include "support/temporary_folder.h"

namespace vps::bench {

namespace {

constexpr double kBar_s = 0.02;

struct Tally {
  int kills = 0, resumed = 0;
};

std::string counts(const char* name, const Tally& tally) {
  return std::string(name) + " " + std::to_string(tally.resumed) + " of " + std::to_string(tally.kills);
}

}  // namespace

bool killRows(int kills, const std::string& network) {
  const test::TemporaryFolder folder;
  test::NodeProcesses nodes(VPS_PROGRAM, VPS_SCENE_FOLDER "/peg_in_hole/scene.toml",
                            "bench-" + std::to_string(getpid()), folder.path(), network);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> wait_s(0.05, 0.5);
  std::array<Tally, 3> tallies;
  std::vector<double> safe_s;
  int unsafe = 0;
  std::size_t most_segments = 0;
  nodes.startDevice();
  nodes.startWatch();
  nodes.startRender();
  for (int i = 0; i < kills; ++i) {
    Tally& tally = tallies[static_cast<std::size_t>(i % 3)];
    // Every few kills a run may have come to its end: the next one is begun.
    if (!nodes.join(network.empty() ? 1 : 4) || !nodes.waitForHold(5)) {
      nodes.render.wait();
      nodes.startRender();
      if (!nodes.join() || !nodes.waitForHold()) break;
    }
    nodes.waitForPhysics(wait_s(random), 3);
    if (nodes.watcher->isOver() || !nodes.waitForHold(1)) {
      --i;
      continue;
    }
    ++tally.kills;
    if (i % 3 == 0) {
      const std::int64_t killed_ns = nodes.render.killNow();
      const std::optional<double> safe = nodes.safeAfter_s(killed_ns);
      if (safe)
        safe_s.push_back(*safe);
      else
        ++unsafe;
      nodes.startRender();
      tally.resumed += nodes.join() && nodes.waitForHold();
    } else if (i % 3 == 1) {
      nodes.device.killNow();
      nodes.startDevice();
      tally.resumed += nodes.waitForHold() && nodes.waitForPhysics(0.1);
    } else {
      nodes.watch.killNow();
      nodes.startWatch();
      tally.resumed += nodes.waitForPhysics(0.1);
    }
    most_segments = std::max(most_segments, nodes.segments());
  }
  nodes.render.killNow();
  const bool is_gone = test::NodeProcesses::waitFor([&] { return nodes.segments() == 0; }, 2);

  std::sort(safe_s.begin(), safe_s.end());
  const auto late = std::count_if(safe_s.begin(), safe_s.end(), [](double s) { return s > kBar_s; });
  char words[240];
  std::snprintf(
      words, sizeof words,
      "zero force after %.1f ms (median), %.1f ms (most) in %zu kills of render; %ld later than 20 ms, "
      "%d not seen",
      safe_s.empty() ? 0.0 : 1e3 * safe_s[safe_s.size() / 2], safe_s.empty() ? 0.0 : 1e3 * safe_s.back(),
      safe_s.size(), static_cast<long>(late), unsafe);
  const bool is_safe = !safe_s.empty() && late == 0 && unsafe == 0;
  const std::string how = network.empty() ? ", shared memory" : ", UDP on " + network;
  printRow("kill -9, device safe" + how, "20 ms", words, is_safe);
  const bool has_resumed = std::all_of(tallies.begin(), tallies.end(),
                                       [](const Tally& t) { return t.resumed == t.kills && t.kills > 0; });
  printRow(
      "kill -9 of each node in turn, " + std::to_string(kills) + " times" + how, "the session resumes",
      counts("render", tallies[0]) + ", " + counts("device", tallies[1]) + ", " + counts("watch", tallies[2]),
      has_resumed);
  printRow("shared segments during and after", "1 and 0",
           std::to_string(most_segments) + " and " + std::to_string(is_gone ? 0 : nodes.segments()),
           most_segments <= 1 && is_gone);
  return is_safe && has_resumed && is_gone;
}

}  // namespace vps::bench
