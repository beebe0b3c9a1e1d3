// SPDX-License-Identifier: BSD-3-Clause
// vps_families: the table of families. Exits 1 if a family fails, is worse than its expected failure, or
// holds although a failure is expected; 2 for an unknown option.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "family.h"

namespace {

using namespace vps::families;

int usage() {
  std::printf(
      "usage: vps_families [--short] [--families=A,B_cubes] [--member=N] [--list]\n"
      "  --short     some members of each family\n"
      "  --families  letters of kinds or keys of families\n"
      "  --member    one member alone\n");
  return 2;
}

// "B" names all families of kind B, "B_cubes" one.
bool isWanted(const std::string& wanted, const std::string& key) {
  return wanted.empty() || wanted.find("," + key + ",") != std::string::npos ||
         wanted.find("," + key.substr(0, key.find('_')) + ",") != std::string::npos;
}

}  // namespace

int main(int argc, char** argv) {
  bool is_short = false, is_list = false;
  int member = -1;
  std::string wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short")
      is_short = true;
    else if (arg == "--list")
      is_list = true;
    else if (arg.rfind("--families=", 0) == 0)
      wanted = "," + arg.substr(11) + ",";
    else if (arg.rfind("--member=", 0) == 0)
      member = std::atoi(argv[i] + 9);
    else
      return usage();
  }
  int wrong = 0, found = 0;
  for (const Family& family : allFamilies()) {
    if (!isWanted(wanted, family.key)) continue;
    ++found;
    if (is_list) {
      std::printf("%-28s %4d members  bar %.3g  %s\n", family.key.c_str(), family.members, family.bar,
                  family.measure.c_str());
      continue;
    }
    const Outcome outcome = measure(family, is_short, member);
    const Verdict verdict = judge(family, outcome, is_short);
    wrong += verdict != Verdict::Holds && verdict != Verdict::ExpectedFailure;
    std::printf("%-28s bar %-9.3g worst %-11.5g above %d of %d  %.1f s  %s\n", family.key.c_str(), family.bar,
                outcome.worst, outcome.above, outcome.run, outcome.cpu_s, nameOf(verdict));
    if (outcome.above > 0 && family.describe)
      std::printf("    member %d: %s\n", outcome.worst_member, family.describe(outcome.worst_member).c_str());
    std::fflush(stdout);
  }
  if (found == 0) return usage();
  return wrong == 0 ? 0 : 1;
}
