// SPDX-License-Identifier: BSD-3-Clause
// vps_bench_peers: the table of the Bullet bridge with its bounds, and other engines for comparison. Exits 1
// if a bound is missed, 2 for an unknown option.
#include <cstdio>
#include <cstring>
#include <string>

#include "rows.h"

int main(int argc, char** argv) {
  using namespace vps;
  bench::Options options{{dynamics::Mode::Constraint, dynamics::Mode::Penalty}, false};
  bench::Table table;
  std::string wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short") {
      options.is_short = true;
    } else if (arg.rfind("--rows=", 0) == 0) {
      wanted = "," + arg.substr(7) + ",";
    } else if (arg == "--mode=constraint") {
      options.modes = {dynamics::Mode::Constraint};
    } else if (arg == "--mode=penalty") {
      options.modes = {dynamics::Mode::Penalty};
    } else if (arg == "--mode=stock") {
      options.modes = {dynamics::Mode::ConstraintStock};
    } else if (arg.rfind("--tsv=", 0) == 0 && table.file.open(arg.substr(6))) {
      continue;
    } else {
      std::printf(
          "usage: vps_bench_peers [--rows=a,b] [--mode=constraint|penalty|stock] [--short] [--tsv=FILE]\n"
          "rows:");
      for (const bench::Case& c : bench::allCases()) std::printf(" %s", c.key);
      std::printf("\n");
      return 2;
    }
  }
  for (const bench::Case& c : bench::allCases())
    if (wanted.empty() ? !c.is_optional : wanted.find("," + std::string(c.key) + ",") != std::string::npos)
      c.run(options, table);
  return table.print() == 0 ? 0 : 1;
}
