// SPDX-License-Identifier: BSD-3-Clause
// Prints Google Benchmark's results as a Markdown table.
#pragma once

#include <benchmark/benchmark.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "cases.h"

namespace vps::bench {

/// Prints to the console and keeps the values of the table.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : benchmark::ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override;

  /// One line a case that was run, in the order of `cases`: bar, median ratio and its spread (p10 to p90 of
  /// the repetitions), times.
  void writeMarkdown(const std::vector<Case>& cases, std::ostream& out) const;

 private:
  using Values = std::map<std::string, double>;
  std::map<std::string, std::map<std::string, Values>> found_;  // case, aggregate, counter
};

}  // namespace vps::bench
