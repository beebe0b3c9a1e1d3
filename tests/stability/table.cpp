// SPDX-License-Identifier: BSD-3-Clause
#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

namespace vps::stability {

namespace {

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

}  // namespace

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

}  // namespace vps::stability
