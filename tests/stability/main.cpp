// SPDX-License-Identifier: BSD-3-Clause
// vps_stability: runs the rows with both contact methods, searches for their limits, and prints the table of
// contact at its extremes. Exits 1 if a required value fails, 2 for an unknown option.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "rows.h"
#include "support/table_rows.h"

namespace vps::stability {
namespace {

struct Options {
  bool is_short = false;     ///< runs only the values that must hold, without the search for limits
  bool is_thorough = false;  ///< rests for hours
  std::vector<Mode> modes = {Mode::Constraint, Mode::Penalty};
};

/// Result of a row in one mode.
struct Result {
  std::string promised;         ///< outcome of the promised values
  std::string limit;            ///< the value at which the row fails, and how
  bool is_met = true;           ///< all promised values hold
  bool is_required_met = true;  ///< all required values hold
  std::string failure;          ///< reason if is_required_met is false
};

std::string labelOf(const Row& row, double value) {
  return row.label ? row.label(value) : toText(value);
}

Judgement runOne(const Row& row, const Run& run) {
  try {
    return row.run(run);
  } catch (const std::exception& error) {
    Judgement judgement;
    judgement.require(false, error.what());
    return judgement;
  }
}

/// Narrows the interval between the last value that holds and the first that fails to about a tenth of a
/// decade.
std::string narrowed(const Row& row, Run run, double holds, double breaks, std::string how) {
  // Three bisections of a decade leave a factor of 1.3.
  for (int i = 0; i < 3 && !row.label && holds > 0 && breaks > 0; ++i) {
    run.value = std::sqrt(holds * breaks);
    const Judgement middle = runOne(row, run);
    if (!middle.holds()) how = middle.text();
    (middle.holds() ? holds : breaks) = run.value;
  }
  return "holds at " + labelOf(row, holds) + ", breaks at " + labelOf(row, breaks) + ": " + how;
}

/// Continues beyond the promised values until one fails.
std::string limitBeyond(const Row& row, Run run, std::size_t promised) {
  for (std::size_t i = promised; i < row.ladder.size(); ++i) {
    run.value = row.ladder[i];
    const Judgement judgement = runOne(row, run);
    if (!judgement.holds()) return narrowed(row, run, row.ladder[i - 1], run.value, judgement.text());
  }
  return "none found up to " + labelOf(row, row.ladder.back());
}

Result runRow(const Row& row, Mode mode, const Options& options) {
  Result result;
  const std::size_t must = std::min(row.promised, row.holds[mode == Mode::Penalty ? 1 : 0]);
  const std::size_t end = options.is_short ? must : row.promised;
  Run run{mode, 0, options.is_thorough};
  for (std::size_t i = 0; i < end; ++i) {
    run.value = row.ladder[i];
    const Judgement judgement = runOne(row, run);
    const std::string outcome = labelOf(row, run.value) + ": " + judgement.text();
    if (judgement.holds()) {
      if (result.is_met) result.promised = outcome;
      continue;
    }
    if (result.is_met && i > 0 && !row.label) {
      result.limit = narrowed(row, run, row.ladder[i - 1], run.value, judgement.text());
      if (options.is_short) result.limit.clear();
    }
    result.promised = result.is_met ? outcome : result.promised + "; " + outcome;
    result.is_met = false;
    if (i >= must) continue;
    result.is_required_met = false;
    result.failure += result.failure.empty() ? outcome : "; " + outcome;
  }
  if (!options.is_short && result.is_met && row.ladder.size() > row.promised)
    result.limit = limitBeyond(row, run, row.promised);
  return result;
}

/// Prints Markdown, one line for each row, and adds each to `file`. Returns how many rows miss a required
/// value.
int printTable(const std::vector<Row>& rows, const Options& options, test::TableRows& file) {
  int missed = 0;
  std::printf("| row | to the extreme | judged by | contact | at the end of the promised values | limit |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    for (const Mode mode : options.modes) {
      const Result r = runRow(row, mode, options);
      const bool is_first = mode == options.modes.front();
      std::printf("| %s | %s | %s | %s | %s%s%s | %s |\n", is_first ? row.key.c_str() : "",
                  is_first ? row.extreme.c_str() : "", is_first ? row.judged.c_str() : "",
                  dynamics::nameOf(mode), r.is_met ? "" : "**breaks** at ", r.promised.c_str(),
                  r.is_required_met ? "" : " **MISSED**", r.limit.c_str());
      std::fflush(stdout);
      file.add("stability " + row.key + ", " + dynamics::nameOf(mode), row.judged, r.promised,
               r.is_required_met ? test::kMet : test::kFailed);
      if (!r.is_required_met) ++missed, std::fprintf(stderr, "%s: %s\n", row.key.c_str(), r.failure.c_str());
    }
  }
  return missed;
}

std::vector<Row> allRows() {
  std::vector<Row> all;
  for (const auto& rows : {loadRows(), scaleRows(), impactRows(), shapeRows(), restRows(), inputRows()})
    all.insert(all.end(), rows.begin(), rows.end());
#ifdef VPS_STABILITY_HAS_DEVICE
  const std::vector<Row> rows = deviceRows();
  all.insert(all.end(), rows.begin(), rows.end());
#endif
  return all;
}

int usage() {
  std::printf(
      "usage: vps_stability [--short] [--thorough] [--rows=a,b] [--mode=constraint|penalty|stock] "
      "[--values=x,y] [--tsv=FILE]\n"
      "  --short     the values that must hold, without the search for limits\n"
      "  --thorough  hours at rest instead of seconds\n"
      "  --values    values that replace those of the rows\n"
      "  --tsv       also writes the rows to this file\n"
      "rows:");
  for (const Row& row : allRows()) std::printf(" %s", row.key.c_str());
  std::printf("\n");
  return 2;
}

std::vector<double> numbers(const char* text) {
  std::vector<double> values;
  for (char* end = nullptr; *text; text = *end == ',' ? end + 1 : end) {
    values.push_back(std::strtod(text, &end));
    if (end == text) return {};
  }
  return values;
}

}  // namespace
}  // namespace vps::stability

int main(int argc, char** argv) {
  using namespace vps::stability;
  Options options;
  vps::test::TableRows rows_file;
  std::string wanted;
  std::vector<double> values;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short") {
      options.is_short = true;
    } else if (arg == "--thorough") {
      options.is_thorough = true;
    } else if (arg.rfind("--rows=", 0) == 0) {
      wanted = "," + arg.substr(7) + ",";
    } else if (arg.rfind("--values=", 0) == 0) {
      values = numbers(argv[i] + 9);
    } else if (arg == "--mode=constraint") {
      options.modes = {Mode::Constraint};
    } else if (arg == "--mode=penalty") {
      options.modes = {Mode::Penalty};
    } else if (arg == "--mode=stock") {
      options.modes = {Mode::ConstraintStock};
    } else if (arg.rfind("--tsv=", 0) == 0) {
      if (!rows_file.open(arg.substr(6))) return usage();
    } else {
      return usage();
    }
  }
  std::vector<Row> rows;
  for (Row& row : allRows()) {
    if (!wanted.empty() && wanted.find("," + row.key + ",") == std::string::npos) continue;
    if (!values.empty()) row.ladder = values, row.promised = values.size();
    rows.push_back(std::move(row));
  }
  if (rows.empty()) return usage();
  return printTable(rows, options, rows_file) == 0 ? 0 : 1;
}
