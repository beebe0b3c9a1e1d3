// SPDX-License-Identifier: BSD-3-Clause
// vps_benchmarks: the speed table. `--check` compares answers on small models and times nothing; see
// README.md for the rest.
#include <benchmark/benchmark.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

#include "cases.h"
#include "table.h"

namespace vps::bench {
namespace {

struct Arguments {
  bool is_check = false;
  int repetitions = 5;
  std::string commit = "not given", table;
};

/// Takes our own arguments out of argv; the rest is Google Benchmark's.
Arguments takeArguments(int& argc, char** argv) {
  Arguments arguments;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto valueAfter = [&](const char* prefix) { return argument.substr(std::strlen(prefix)); };
    if (argument == "--check")
      arguments.is_check = true;
    else if (argument.starts_with("--commit="))
      arguments.commit = valueAfter("--commit=");
    else if (argument.starts_with("--table="))
      arguments.table = valueAfter("--table=");
    else if (argument.starts_with("--repetitions="))
      arguments.repetitions = std::max(1, std::atoi(valueAfter("--repetitions=").c_str()));
    else
      argv[kept++] = argv[i];
  }
  argc = kept;
  return arguments;
}

/// Every row on small models: answers agree, and the clock gives numbers. 0 or 1.
int checkAll() {
  int failures = 0;
  for (const Case& c : tableCases({.points = 3000, .voxels = 64, .coarser = 6})) {
    try {
      if (c.check) c.check();
      const Counters counters = c.measure(0);
      std::cout << c.name << ": agrees, " << counters.size() << " numbers\n";
    } catch (const std::exception& e) {
      std::cout << e.what() << "\n";
      ++failures;
    }
  }
  return failures == 0 ? 0 : 1;
}

std::string cpuName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
  return "unknown";
}

void runOnce(benchmark::State& state, const Case& c, int& repetition) {
  try {
    if (repetition == 0 && c.check) c.check();
    for ([[maybe_unused]] auto _ : state) {
      const Counters counters = c.measure(repetition++);
      for (const auto& [name, value] : counters) state.counters[name] = value;
      const auto ours = counters.find("ours_us");
      state.SetIterationTime(ours == counters.end() ? 1e-9 : 1e-6 * ours->second);
    }
  } catch (const std::exception& e) {
    state.SkipWithError(e.what());
  }
}

void registerCase(const Case& c, int repetitions) {
  auto repetition = std::make_shared<int>(0);
  benchmark::RegisterBenchmark(c.name.c_str(),
                               [c, repetition](benchmark::State& state) { runOnce(state, c, *repetition); })
      ->Iterations(1)
      ->Repetitions(repetitions)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond)
      ->ComputeStatistics("p10", [](const std::vector<double>& v) { return quantile(v, 0.1); })
      ->ComputeStatistics("p90", [](const std::vector<double>& v) { return quantile(v, 0.9); });
}

int runTable(int argc, char** argv, const Arguments& arguments) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("cpu", cpuName());
  benchmark::AddCustomContext("compiler", VPS_BENCHMARK_COMPILER);
  benchmark::AddCustomContext("flags", VPS_BENCHMARK_FLAGS);
  benchmark::AddCustomContext("commit", arguments.commit);
  const std::vector<Case> cases = tableCases({});
  for (const Case& c : cases) registerCase(c, arguments.repetitions);
  TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.writeMarkdown(cases, std::cout);
  if (!arguments.table.empty()) {
    std::ofstream out(arguments.table);
    reporter.writeMarkdown(cases, out);
  }
  return 0;
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  const vps::bench::Arguments arguments = vps::bench::takeArguments(argc, argv);
  return arguments.is_check ? vps::bench::checkAll() : vps::bench::runTable(argc, argv, arguments);
}
