// SPDX-License-Identifier: BSD-3-Clause
#include "table.h"

#include <cstdio>
#include <ostream>

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

}  // namespace

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

}  // namespace vps::bench
