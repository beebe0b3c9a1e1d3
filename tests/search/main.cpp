// SPDX-License-Identifier: BSD-3-Clause
// vps_search: random cases of sharp-edged parts, and how deep they overlap. Exits 1 if a case exceeds the
// bound, 2 for an unknown option.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "case_run.h"
#include "families.h"
#include "support/table_rows.h"

namespace vps::search {
namespace {

/// A row is a family, a time step, and closed or faulty meshes.
struct SearchOptions {
  std::uint64_t seed = 0;             ///< of the first case of each row; the others count up
  double minutes = 0;                 ///< wall time for all rows; 0: no limit
  double seconds_simulated = 0;       ///< of each row; 0: no limit
  long runs = 0;                      ///< of each row; 0: no limit
  std::vector<std::string> families;  ///< empty: all
  std::vector<double> steps_s{1e-3, 4e-3, 10e-3};
  bool has_closed = true, has_faulty = true;
  dynamics::Mode mode = dynamics::Mode::Constraint;
  std::string save_folder = "out/search";  ///< for cases that exceed the bound
  std::string rows_file;                   ///< file for the rows (support/table_rows.h); empty: none
  bool is_verbose = false;
};

struct Row {
  const Family* family;
  double step_s;
  bool is_faulty;
  long runs = 0, over = 0, tunnelled = 0, refused = 0;
  double simulated_s = 0, deepest_m = 0;
  std::uint64_t worst_seed = 0;
  bool is_good = true;
  double cpu_s = 0;
};

std::vector<Row> rowsOf(const SearchOptions& options) {
  std::vector<Row> rows;
  for (const Family& family : families()) {
    if (!options.families.empty() &&
        std::find(options.families.begin(), options.families.end(), family.name) == options.families.end())
      continue;
    for (const double step_s : options.steps_s)
      for (const bool is_faulty : {false, true})
        if (is_faulty ? options.has_faulty : options.has_closed) rows.push_back({&family, step_s, is_faulty});
  }
  return rows;
}

std::string text(const char* format, auto... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

const char* meshesOf(const Row& row) {
  return row.is_faulty ? "faulty" : "closed";
}

std::string commandOf(const SearchOptions& options, const Row& row, std::uint64_t seed) {
  return text("vps_search --family %s --step-ms %g --meshes %s --mode %s --seed %llu --runs 1",
              row.family->name, 1e3 * row.step_s, meshesOf(row), dynamics::nameOf(options.mode),
              static_cast<unsigned long long>(seed));
}

/// Cases with longer steps and in penalty contact have no bound of depth.
bool hasBound(const SearchOptions& options, const Row& row) {
  return options.mode == dynamics::Mode::Constraint && row.step_s <= 1.001e-3;
}

/// See printTable() for what counts as a failure.
bool isFailure(const SearchOptions& options, const Row& row, const RunSettings& settings,
               const CaseResult& result) {
  if (!result.refusal.empty() || result.has_tunnelled) return true;
  return hasBound(options, row) && result.deepest.overlap.depth_m > settings.bound_m;
}

/// @return false for a failure
bool runNext(const SearchOptions& options, Row& row) {
  const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(row.runs);
  const std::clock_t begun = std::clock();
  const Case made = makeCase(*row.family, seed, row.is_faulty);
  RunSettings settings;
  settings.mode = options.mode;
  settings.step_s = row.step_s;
  const CaseResult result = runCase(made, settings);
  const double deepest_m = result.deepest.overlap.depth_m;
  ++row.runs;
  row.simulated_s += result.simulated_s;
  row.over += deepest_m > settings.bound_m;
  row.tunnelled += result.has_tunnelled;
  row.refused += !result.refusal.empty();
  if (deepest_m > row.deepest_m) row.deepest_m = deepest_m, row.worst_seed = seed;
  const bool is_failure = isFailure(options, row, settings, result);
  row.is_good = row.is_good && !is_failure;
  row.cpu_s += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  if (is_failure || options.is_verbose) {
    std::printf("%s: %.2f um at %.4f s, %s in %s%s%s%s; hash %016llx\n",
                commandOf(options, row, seed).c_str(), 1e6 * deepest_m, result.deepest_at_s,
                made.bodies[result.deepest.a].name.c_str(), made.bodies[result.deepest.b].name.c_str(),
                result.has_tunnelled ? ", tunnelled" : "",
                result.refusal.empty() ? "" : ", refused: ", result.refusal.c_str(),
                static_cast<unsigned long long>(result.hash));
    std::fflush(stdout);
  }
  if (is_failure && !result.before.empty() && !options.save_folder.empty()) {
    const std::string name = text("%s-%llu-%gms%s", row.family->name, static_cast<unsigned long long>(seed),
                                  1e3 * row.step_s, row.is_faulty ? "-faulty" : "");
    std::printf("  saved as %s\n", saveCase(options.save_folder + "/" + name, made, settings, result,
                                            commandOf(options, row, seed))
                                       .c_str());
  }
  return !is_failure;
}

bool isDone(const SearchOptions& options, const Row& row) {
  return (options.runs > 0 && row.runs >= options.runs) ||
         (options.seconds_simulated > 0 && row.simulated_s >= options.seconds_simulated);
}

void print(const std::vector<Row>& rows) {
  std::printf(
      "\n| family | step [ms] | meshes | runs | simulated [s] | deepest [um] | seed of the deepest | over "
      "10 um | tunnelled | refused |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows)
    std::printf("| %s | %g | %s | %ld | %.1f | %.2f | %llu | %ld | %ld | %ld |\n", row.family->name,
                1e3 * row.step_s, meshesOf(row), row.runs, row.simulated_s, 1e6 * row.deepest_m,
                static_cast<unsigned long long>(row.worst_seed), row.over, row.tunnelled, row.refused);
}

bool write(const SearchOptions& options, const std::vector<Row>& rows) {
  if (options.rows_file.empty()) return true;
  test::TableRows file;
  if (!file.open(options.rows_file)) return false;
  for (const Row& row : rows)
    file.add(text("search %s, %g ms, %s, %s", row.family->name, 1e3 * row.step_s, meshesOf(row),
                  dynamics::nameOf(options.mode)),
             hasBound(options, row) ? text("%ld cases <= %g um", row.runs, 1e6 * RunSettings().bound_m)
                                    : text("%ld cases, none passes through", row.runs),
             text("%.2f um, %ld tunnelled, %ld refused", 1e6 * row.deepest_m, row.tunnelled, row.refused),
             row.is_good ? test::kMet : test::kFailed, row.cpu_s);
  return true;
}

/// Runs one case of each row in turn, so that the rows share a limit of time. Prints each case that exceeds
/// the bound with the command that repeats it, then the table.
/// @return true if no case exceeded its bound: 10 um with steps of 1 ms and constraint contact; other
/// settings only must not tunnel. A case that the engine refuses counts as a failure.
bool printTable(const SearchOptions& options) {
  using Clock = std::chrono::steady_clock;
  std::vector<Row> rows = rowsOf(options);
  std::printf("seed %llu, %s contact\n", static_cast<unsigned long long>(options.seed),
              dynamics::nameOf(options.mode));
  const auto begun = Clock::now();
  const auto isOutOfTime = [&] {
    return options.minutes > 0 &&
           std::chrono::duration<double>(Clock::now() - begun).count() > 60 * options.minutes;
  };
  bool is_good = true;
  for (bool has_more = true; has_more && !isOutOfTime();) {
    has_more = false;
    for (Row& row : rows) {
      if (isDone(options, row) || isOutOfTime()) continue;
      is_good = runNext(options, row) && is_good;
      has_more = true;
    }
  }
  print(rows);
  return write(options, rows) && is_good;
}

int usage() {
  std::printf(
      "usage: vps_search [--minutes M | --seconds-simulated S | --runs N] [--family a,b] [--step-ms 1,4,10]\n"
      "                  [--meshes closed,faulty] [--mode constraint|penalty] [--seed N] [--save FOLDER]\n"
      "  --minutes            wall time for all rows together (default 1)\n"
      "  --seconds-simulated  for each row\n"
      "  --runs               cases of each row\n"
      "  --seed               of the first case; the others count up from it (default: from the date)\n"
      "  --save               folder for cases that exceed the bound (default: out/search)\n"
      "  --tsv                a file for the rows\n"
      "  --verbose            a line for each case\n"
      "families:\n");
  for (const Family& family : families()) std::printf("  %-14s %s\n", family.name, family.description);
  return 2;
}

std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::uint64_t seedOfToday() {
  const std::time_t now = std::time(nullptr);
  std::tm day{};
  gmtime_r(&now, &day);
  return static_cast<std::uint64_t>((day.tm_year + 1900) * 10000 + (day.tm_mon + 1) * 100 + day.tm_mday) *
         1000000;
}

bool take(SearchOptions& options, const std::string& name, const std::string& value) {
  if (name == "--minutes") {
    options.minutes = std::atof(value.c_str());
  } else if (name == "--seconds-simulated") {
    options.seconds_simulated = std::atof(value.c_str());
  } else if (name == "--runs") {
    options.runs = std::atol(value.c_str());
  } else if (name == "--seed") {
    options.seed = std::strtoull(value.c_str(), nullptr, 10);
  } else if (name == "--save") {
    options.save_folder = value;
  } else if (name == "--tsv") {
    options.rows_file = value;
  } else if (name == "--family") {
    options.families = parts(value);
    for (const std::string& family : options.families)
      if (!findFamily(family)) return false;
  } else if (name == "--step-ms") {
    options.steps_s.clear();
    for (const std::string& step : parts(value)) options.steps_s.push_back(1e-3 * std::atof(step.c_str()));
    for (const double step_s : options.steps_s)
      if (!(step_s > 0)) return false;
  } else if (name == "--meshes") {
    options.has_closed = options.has_faulty = false;
    for (const std::string& kind : parts(value)) {
      if (kind != "closed" && kind != "faulty") return false;
      (kind == "closed" ? options.has_closed : options.has_faulty) = true;
    }
  } else if (name == "--mode" && (value == "constraint" || value == "penalty")) {
    options.mode = value == "penalty" ? vps::dynamics::Mode::Penalty : vps::dynamics::Mode::Constraint;
  } else {
    return false;
  }
  return true;
}

}  // namespace
}  // namespace vps::search

int main(int argc, char** argv) {
  using namespace vps::search;
  SearchOptions options;
  options.seed = seedOfToday();
  for (int i = 1; i < argc; ++i) {
    std::string name = argv[i];
    if (name == "--verbose") {
      options.is_verbose = true;
      continue;
    }
    std::string value;
    const std::size_t equals = name.find('=');
    if (equals != std::string::npos) {
      value = name.substr(equals + 1);
      name.resize(equals);
    } else if (i + 1 < argc) {
      value = argv[++i];
    }
    if (!take(options, name, value)) return usage();
  }
  if (!(options.minutes > 0) && !(options.seconds_simulated > 0) && options.runs <= 0) options.minutes = 1;
  return printTable(options) ? 0 : 1;
}
