// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "edge_case.h"
#include "support/table_rows.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {

namespace {

struct Row {
  std::string name;
  int cases = 0, right = 0, not_shown = 0, missed = 0, wrong = 0, refused = 0;
  double deepest_m = 0, cpu_s = 0;
};

void count(Row& row, EdgeOutcome outcome) {
  ++row.cases;
  row.right += outcome == EdgeOutcome::Right;
  row.not_shown += outcome == EdgeOutcome::NotShown;
  row.missed += outcome == EdgeOutcome::MissedFit;
  row.wrong += outcome == EdgeOutcome::Wrong;
}

void print(const Row& row) {
  std::printf("| %-32s | %5d | %5d | %9d | %6d | %5d | %7d |\n", row.name.c_str(), row.cases, row.right,
              row.not_shown, row.missed, row.wrong, row.refused);
}

void printCase(const EdgeCase& edge, const scenes::StepResult& step, EdgeOutcome outcome) {
  constexpr const char* kWords[] = {"right", "within the band", "MISSED", "WRONG"};
  std::printf(
      "%-40s seed %llu: %s, %s; %.1f s; deepest %.2f um; overlap %.2f +- %.2f um; "
      "guided by %.2f N; error %.1f um; %s\n",
      caseName(edge).c_str(), static_cast<unsigned long long>(edge.seed), toText(step.verdict),
      kWords[static_cast<int>(outcome)], step.duration_s, 1e6 * step.max_penetration_m,
      1e6 * step.blocked_depth_m, 1e6 * step.blocked_error_m, step.guide_force_N, 1e6 * step.final_error_m,
      step.reason.c_str());
  for (const scenes::StrategyUse& use : step.strategies)
    std::printf("  from %5.1f s for %4.1f s: %s\n", use.start_s, use.duration_s, use.strategy.c_str());
  std::fflush(stdout);
}

EdgeOutcome outcomeWithoutWall(const scenes::StepResult& step) {
  return step.by_contact ? EdgeOutcome::Wrong : EdgeOutcome::Right;
}

void runCase(const EdgeCase& edge, const EdgeTableSettings& settings, Row& row) {
  scenes::Scene scene = edgeScene(edge);
  scenes::AssembleOptions options;
  options.judge_stride = 200;
  const scenes::StepResult step = scenes::assemble(scene, options).steps.at(0);
  const EdgeOutcome outcome = settings.has_wall ? outcomeOf(edge, step.verdict) : outcomeWithoutWall(step);
  if (settings.is_verbose || outcome == EdgeOutcome::Wrong || outcome == EdgeOutcome::MissedFit)
    printCase(edge, step, outcome);
  row.deepest_m = std::max(row.deepest_m, step.max_penetration_m);
  count(row, outcome);
}

bool write(const std::vector<Row>& rows, const std::string& path) {
  test::TableRows file;
  if (path.empty()) return true;
  if (!file.open(path)) return false;
  for (const Row& row : rows) {
    char value[128];
    std::snprintf(value, sizeof value, "%d right, %d not shown, %d missed, %d wrong, %d refused; %.2f um",
                  row.right, row.not_shown, row.missed, row.wrong, row.refused, 1e6 * row.deepest_m);
    file.add("hand edge, " + row.name, std::to_string(row.cases) + " cases, none wrong", value,
             row.wrong == 0 ? test::kMet : test::kFailed, row.cpu_s);
  }
  return true;
}

void add(Row& to, const Row& row) {
  to.cases += row.cases;
  to.right += row.right;
  to.not_shown += row.not_shown;
  to.missed += row.missed;
  to.wrong += row.wrong;
  to.refused += row.refused;
}

}  // namespace

int printEdgeTable(const EdgeTableSettings& settings) {
  std::vector<Row> rows;
  const std::vector<EdgeCase> cases = edgeCases(settings.seed);
  for (std::size_t i = settings.first; i < cases.size(); i += settings.every) {
    EdgeCase edge = cases[i];
    edge.fit.has_wall = settings.has_wall;
    if (rowName(edge).find(settings.only) == std::string::npos) continue;
    if (rows.empty() || rows.back().name != rowName(edge)) rows.push_back({rowName(edge)});
    const std::clock_t begun = std::clock();
    try {
      runCase(edge, settings, rows.back());
    } catch (const LoadError& error) {
      ++rows.back().cases;
      ++rows.back().refused;
      std::printf("%s: %s\n", caseName(edge).c_str(), error.what());
    }
    rows.back().cpu_s += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  }
  std::printf("| %-32s | cases | right | not shown | missed | wrong | refused |\n", "");
  std::printf(
      "|----------------------------------|-------|-------|-----------|--------|-------|---------|\n");
  Row total{"all"};
  for (const Row& row : rows) {
    print(row);
    add(total, row);
  }
  print(total);
  if (write(rows, settings.rows_file)) return total.wrong;
  std::fprintf(stderr, "%s: cannot be written\n", settings.rows_file.c_str());
  return total.wrong + 1;
}

}  // namespace vps::hand
