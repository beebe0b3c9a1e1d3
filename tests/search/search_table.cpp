// SPDX-License-Identifier: BSD-3-Clause
#include "search_table.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "scene_writer.h"
#include "support/table_rows.h"

namespace vps::search {

namespace {

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

/// What makes a run a failure: see printTable().
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

}  // namespace

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

}  // namespace vps::search
