// SPDX-License-Identifier: BSD-3-Clause
// vps_benchmarks: the speed table. `--check` compares answers on small models and times nothing; see
// README.md for the rest.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iosfwd>
#include <iostream>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "cases.h"

namespace vps::bench {
namespace {

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Formats three digits in a suitable unit.
std::string timeText(double us) {
  if (us < 1e3) return formatted(us < 10 ? "%.2f us" : us < 100 ? "%.1f us" : "%.0f us", us);
  return us < 1e6 ? formatted("%.3g ms", us * 1e-3) : formatted("%.3g s", us * 1e-6);
}

std::string barText(const Case& c) {
  switch (c.bar) {
    case Bar::RatioAtLeast:
      return formatted(">= %gx", c.bar_value);
    case Bar::P99Below_us:
      return "p99 < " + timeText(c.bar_value);
    case Bar::TimeBelow_us:
      return "<= " + timeText(c.bar_value);
    case Bar::ShareAtMost:
      return formatted("<= %g", c.bar_value);
    case Bar::None:
      break;
  }
  return "";
}

using Values = std::map<std::string, double>;

double valueOf(const Values& values, const std::string& name) {
  const auto at = values.find(name);
  return at == values.end() ? 0 : at->second;
}

std::string ratioText(const Values& median, const Values& p10, const Values& p90, const char* name,
                      const char* format) {
  if (median.count(name) == 0) return "";
  return formatted(format, valueOf(median, name)) + " (" + formatted(format, valueOf(p10, name)) + " to " +
         formatted(format, valueOf(p90, name)) + ")";
}

std::string percentilesText(const Values& median) {
  if (median.count("p90_us") == 0)
    return median.count("ours_us") > 0 ? timeText(valueOf(median, "ours_us")) : "";
  return timeText(valueOf(median, "ours_us")) + " / " + timeText(valueOf(median, "p90_us")) + " / " +
         timeText(valueOf(median, "p99_us"));
}

std::string perPointText(const Values& median) {
  if (median.count("rival_ns_per_point") == 0) return "";
  std::string text = formatted("%.2f : ", valueOf(median, "ours_ns_per_point")) +
                     formatted("%.1f", valueOf(median, "rival_ns_per_point"));
  if (median.count("nano_ns_per_point") > 0)
    text += formatted(" : %.1f", valueOf(median, "nano_ns_per_point"));
  return text;
}

void writeRow(const Case& c, const Values& median, const Values& p10, const Values& p90, std::ostream& out) {
  const bool is_memory = median.count("share") > 0;
  out << "| " << c.row << " | " << barText(c) << " | "
      << (is_memory ? formatted("%.2f of", valueOf(median, "share"))
                    : ratioText(median, p10, p90, "ratio", "%.3gx"))
      << " | " << (is_memory ? formatted("%.1f MB", valueOf(median, "ours_MB")) : percentilesText(median))
      << " | "
      << (is_memory                      ? formatted("%.1f MB", valueOf(median, "rival_MB"))
          : median.count("rival_us") > 0 ? timeText(valueOf(median, "rival_us"))
                                         : "")
      << " | " << perPointText(median) << " | "
      << (median.count("touching") > 0 ? formatted("%.0f", valueOf(median, "touching")) : "") << " |\n";
}

/// A reporter that prints to the console and keeps the values of the table.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : benchmark::ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override;

  /// Writes one line for each case that was run, in the order of `cases`: bar, median ratio and its spread
  /// (p10 to p90 of the repetitions), times.
  void writeMarkdown(const std::vector<Case>& cases, std::ostream& out) const;

 private:
  std::map<std::string, std::map<std::string, Values>> found_;  // case, aggregate, counter
};

void TableReporter::ReportRuns(const std::vector<Run>& runs) {
  benchmark::ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Aggregate) continue;
    for (const auto& [name, counter] : run.counters)
      found_[run.run_name.function_name][run.aggregate_name][name] = counter.value;
  }
}

void TableReporter::writeMarkdown(const std::vector<Case>& cases, std::ostream& out) const {
  out << "| case | bar | ratio, median (p10 to p90) | ours, p50 / p90 / p99 | OpenVDB | ns a point: ours : "
         "OpenVDB : NanoVDB | touching |\n|---|---|---|---|---|---|---|\n";
  for (const Case& c : cases) {
    const auto found = found_.find(c.name);
    if (found == found_.end()) continue;
    const auto of = [&](const char* aggregate) {
      const auto at = found->second.find(aggregate);
      return at == found->second.end() ? Values{} : at->second;
    };
    writeRow(c, of("median"), of("p10"), of("p90"), out);
  }
}

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

/// Checks every row on small models: the answers must agree and the clock must give numbers. Returns the exit
/// status, 0 or 1.
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
