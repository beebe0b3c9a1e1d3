// SPDX-License-Identifier: BSD-3-Clause
// vps_bench_nodes [latency|run SCENE|wire SCENE|links|kills N|kills-udp N|clock SECONDS|watchers SCENE|
// hostile SCENE|endurance SECONDS]...: without words, all rows, which take some 100 minutes.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "rows.h"

namespace vps::bench {

void printRow(const std::string& what, const std::string& bar, const std::string& measured, bool is_reached) {
  std::printf("| %s | %s | %s | %s |\n", what.c_str(), bar.c_str(), measured.c_str(),
              is_reached ? "reached" : "MISSED");
  std::fflush(stdout);
}

#ifndef VPS_HAS_ICEORYX
bool iceoryxRow(double) {
  printRow("iceoryx, shared memory", "for comparison", "not measured: this build has no iceoryx", true);
  return true;
}
#endif

}  // namespace vps::bench

int main(int argc, char** argv) {
  using namespace vps::bench;
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty())
    words = {"latency",
             "run",
             VPS_SCENE_FOLDER "/bearing_block/scene.toml",
             "wire",
             VPS_SCENE_FOLDER "/peg_in_hole/scene.toml",
             "links",
             "kills",
             "100",
             "clock",
             "60",
             "watchers",
             VPS_SCENE_FOLDER "/peg_in_hole/scene.toml",
             "hostile",
             VPS_SCENE_FOLDER "/peg_in_hole/scene.toml",
             "endurance",
             "3600"};
  std::printf("| case | bar | measured | |\n|---|---|---|---|\n");
  std::fflush(stdout);  // so that the table's head is printed before the rows of other processes
  bool is_good = true;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_more = i + 1 < words.size();
    if (words[i] == "latency")
      is_good = iceoryxRow(10) && latencyRows(10) && is_good;
    else if (words[i] == "run" && has_more)
      is_good = runRows(words[++i]) && is_good;
    else if (words[i] == "wire" && has_more)
      is_good = wireRows(words[++i]) && is_good;
    else if (words[i] == "links")
      is_good = linkRows() && is_good;
    else if (words[i] == "kills" && has_more)
      is_good = killRows(std::atoi(words[++i].c_str()), "") && is_good;
    else if (words[i] == "kills-udp" && has_more)
      is_good = killRows(std::atoi(words[++i].c_str()), "lo") && is_good;
    else if (words[i] == "clock" && has_more)
      is_good = clockRow(std::atof(words[++i].c_str())) && is_good;
    else if (words[i] == "watchers" && has_more)
      is_good = watcherRows(words[++i]) && is_good;
    else if (words[i] == "hostile" && has_more)
      is_good = hostileRow(words[++i]) && is_good;
    else if (words[i] == "endurance" && has_more)
      is_good = enduranceRow(std::atof(words[++i].c_str())) && is_good;
    else
      return std::fprintf(stderr, "unknown: %s\n", words[i].c_str()), 2;
  }
  return is_good ? 0 : 1;
}
