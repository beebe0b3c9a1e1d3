// SPDX-License-Identifier: BSD-3-Clause
// kill -9 of each node in turn: how soon the device is safe, whether the session continues, and what is left
// behind.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "rows.h"
#include "support/process/node_processes.h"
#include "support/temporary_folder.h"
#include "vps_device/periodic_thread.h"

namespace vps::bench {

namespace {

constexpr double kRecovery_s = 0.02;

struct Tally {
  int kills = 0, resumed = 0;
};

/// Memory of the processes of a role, one after the other, each measured before its kill.
class MemoryOfKills {
 public:
  void look(const test::ChildProcess& process) {
    if (process.isRunning()) all_MB_.push_back(test::usageOf(process.id()).memory_MB);
  }
  /// Median of the memory in the first third of the kills; late_MB() is the median of the last third.
  [[nodiscard]] double early_MB() const { return median({all_MB_.begin(), all_MB_.begin() + third()}); }
  [[nodiscard]] double late_MB() const { return median({all_MB_.end() - third(), all_MB_.end()}); }
  [[nodiscard]] bool isSteady() const {
    // assumed: about the memory that an allocator keeps, and the effect of the moment in the run
    return !all_MB_.empty() && late_MB() - early_MB() <= std::max(1.0, 0.05 * early_MB());
  }

 private:
  [[nodiscard]] std::ptrdiff_t third() const { return static_cast<std::ptrdiff_t>((all_MB_.size() + 2) / 3); }
  static double median(std::vector<double> some) {
    if (some.empty()) return 0;
    std::sort(some.begin(), some.end());
    return some[some.size() / 2];
  }
  std::vector<double> all_MB_;
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
  std::array<MemoryOfKills, 3> memory;
  double own_early_MB =
      0;  // memory of this process, which joins each session as a watcher and is never killed
  nodes.startDevice();
  nodes.startWatch();
  nodes.startRender();
  for (int i = 0; i < kills; ++i) {
    Tally& tally = tallies[static_cast<std::size_t>(i % 3)];
    // Every few kills the run may have ended; then the next run is started.
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
    const std::array<const test::ChildProcess*, 3> alive = {&nodes.render, &nodes.device, &nodes.watch};
    for (std::size_t role = 0; role < alive.size(); ++role) memory[role].look(*alive[role]);
    if (i <= kills / 3) own_early_MB = test::usageOf(getpid()).memory_MB;
    if (i % 3 == 0) {
      // The thread has real-time priority and reads before it waits for the dead process: only the newest
      // state of the device can be read, so a late reader would see a later state.
      device::requestRealTime(60, false);
      const std::int64_t killed_ns = nodes.render.sendKill();
      const std::optional<double> safe = nodes.safeAfter_s(killed_ns);
      device::leaveRealTime();
      nodes.render.killNow();
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
  const auto late = std::count_if(safe_s.begin(), safe_s.end(), [](double s) { return s > kRecovery_s; });
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
  const double own_MB = test::usageOf(getpid()).memory_MB;
  std::snprintf(
      words, sizeof words,
      "render %.1f and %.1f MB, device %.1f and %.1f, watch %.1f and %.1f; a watcher that was never killed "
      "%.1f and %.1f",
      memory[0].early_MB(), memory[0].late_MB(), memory[1].early_MB(), memory[1].late_MB(),
      memory[2].early_MB(), memory[2].late_MB(), own_early_MB, own_MB);
  const bool is_steady =
      own_MB - own_early_MB <= 1 &&
      std::all_of(memory.begin(), memory.end(), [](const MemoryOfKills& one) { return one.isSteady(); });
  printRow("memory in the first and the last third of the kills" + how, "at most 1 MB or 5 % more", words,
           is_steady);
  return is_safe && has_resumed && is_gone && is_steady;
}

}  // namespace vps::bench
