// SPDX-License-Identifier: BSD-3-Clause
// vps_families: the table of families. Exits 1 if a family fails, is worse than its expected failure, or
// holds although a failure is expected; 2 for an unknown option.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "families/family.h"
#include "support/table_rows.h"

namespace {

using namespace vps::families;

int usage() {
  std::printf(
      "usage: vps_families [--short] [--families=A,B_cubes] [--member=N] [--list] [--tsv=FILE]\n"
      "  --short     some members of each family\n"
      "  --families  letters of kinds or keys of families\n"
      "  --member    one member alone; its value is not compared with an expected failure\n"
      "  --tsv       also writes the rows to this file\n");
  return 2;
}

struct Options {
  bool is_short = false, is_list = false;
  int member = -1;
  std::string wanted;  // ",A,B_cubes,"; empty: all
  vps::test::TableRows file;

  // "B" names all families of kind B, "B_cubes" one.
  [[nodiscard]] bool wants(const std::string& key) const {
    return wanted.empty() || wanted.find("," + key + ",") != std::string::npos ||
           wanted.find("," + key.substr(0, key.find('_')) + ",") != std::string::npos;
  }
};

bool read(Options& options, int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short")
      options.is_short = true;
    else if (arg == "--list")
      options.is_list = true;
    else if (arg.rfind("--families=", 0) == 0)
      options.wanted = "," + arg.substr(11) + ",";
    else if (arg.rfind("--member=", 0) == 0)
      options.member = std::atoi(argv[i] + 9);
    else if (arg.rfind("--tsv=", 0) != 0 || !options.file.open(arg.substr(6)))
      return false;
  }
  return true;
}

// True for a letter that names a kind of situations; a kind may have no families yet.
bool isKind(const std::string& wanted) {
  return wanted.size() == 3 && wanted[1] >= 'A' && wanted[1] <= 'N';
}

void list(const Family& family) {
  std::printf("%-28s %4d members  bar %.3g  %s\n", family.key.c_str(), family.members, family.bar,
              family.measure.c_str());
}

// "3-5, 8": members that are next to each other in the run are a range.
std::string rangesOf(const std::vector<int>& members, int every) {
  std::string text;
  for (std::size_t i = 0; i < members.size();) {
    std::size_t end = i;
    while (end + 1 < members.size() && members[end + 1] == members[end] + every) ++end;
    text += (text.empty() ? "" : ", ") + std::to_string(members[i]);
    if (end > i) text += "-" + std::to_string(members[end]);
    i = end + 1;
  }
  return text;
}

void print(const Family& family, const Outcome& outcome, Verdict verdict, int every) {
  std::printf("%-28s bar %-9.3g worst %-11.5g above %d of %d  %.1f s  %s\n", family.key.c_str(), family.bar,
              outcome.worst, outcome.above, outcome.run, outcome.cpu_s, nameOf(verdict));
  if (outcome.above > 0) {
    std::printf("    worst: member %d%s%s\n", outcome.worst_member, family.describe ? ": " : "",
                family.describe ? family.describe(outcome.worst_member).c_str() : "");
    std::printf("    above the bar: %s\n", rangesOf(outcome.members_above, every).c_str());
  }
  std::fflush(stdout);
}

bool isGood(Verdict verdict) {
  return verdict == Verdict::Holds || verdict == Verdict::ExpectedFailure;
}

void write(const Family& family, const Outcome& outcome, Verdict verdict, vps::test::TableRows& file) {
  char bound[32], value[64];
  std::snprintf(bound, sizeof bound, "<= %.3g", family.bar);
  std::snprintf(value, sizeof value, "%.5g (%d of %d above)", outcome.worst, outcome.above, outcome.run);
  file.add("families " + family.key + ": " + family.measure, bound, value,
           verdict == Verdict::Holds             ? vps::test::kMet
           : verdict == Verdict::ExpectedFailure ? vps::test::kExpected
                                                 : nameOf(verdict),
           outcome.cpu_s);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read(options, argc, argv)) return usage();
  int wrong = 0, found = 0;
  for (Family& family : allFamilies()) {
    if (!options.wants(family.key)) continue;
    ++found;
    if (options.is_list) {
      list(family);
      continue;
    }
    if (options.member >= 0) family.expected_failure = family.expected_failure_short = std::nullopt;
    const Outcome outcome = measure(family, options.is_short, options.member);
    const Verdict verdict = judge(family, outcome, options.is_short);
    wrong += !isGood(verdict);
    print(family, outcome, verdict, options.is_short ? family.every : 1);
    write(family, outcome, verdict, options.file);
  }
  if (found == 0 && isKind(options.wanted)) {
    std::printf("kind %c has no families yet\n", options.wanted[1]);
    options.file.add(std::string("families ") + options.wanted[1], "", "none yet", vps::test::kReported);
    return 0;
  }
  if (found == 0) return usage();
  return wrong == 0 ? 0 : 1;
}
