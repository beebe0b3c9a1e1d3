// SPDX-License-Identifier: BSD-3-Clause
// vps_bench_haptics: measures the required figures of device and coupling. Exits with 1 if a bound is missed,
// 2 for an unknown option or row.
#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "rows.h"

namespace vps::bench {
namespace {

const std::vector<HapticCase>& allHapticCases() {
  static const std::vector<HapticCase> cases = {
      {"kinematics", kinematicsRow}, {"statics", staticsRow},
      {"passivity", passivityRow},   {"ringing", ringingRow},
      {"stiffest", stiffestWallRow}, {"press", pressRow},
      {"slide", slideRow},           {"free", freeMotionRow},
#ifdef VPS_HAS_SCENES
      {"injected", injectedRow},     {"tick", tickRow},
      {"points", pointsRow},
#endif
  };
  return cases;
}

int usage() {
  std::printf("usage: vps_bench_haptics [--rows=a,b] [--short]\nrows:");
  for (const HapticCase& c : allHapticCases()) std::printf(" %s", c.key);
  std::printf("\n");
  return 2;
}

bool isKnown(const std::string& key) {
  return std::any_of(allHapticCases().begin(), allHapticCases().end(),
                     [&](const HapticCase& c) { return key == c.key; });
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  using namespace vps::bench;
  HapticOptions options;
  std::vector<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short") {
      options.is_short = true;
    } else if (arg.rfind("--rows=", 0) == 0) {
      std::istringstream keys(arg.substr(7));
      for (std::string key; std::getline(keys, key, ',');) wanted.push_back(key);
    } else {
      return usage();
    }
  }
  if (!std::all_of(wanted.begin(), wanted.end(), isKnown)) return usage();
  Table table;
  for (const HapticCase& c : allHapticCases())
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), c.key) != wanted.end())
      c.run(options, table);
  return table.print() == 0 ? 0 : 1;
}
