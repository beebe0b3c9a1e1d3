// SPDX-License-Identifier: BSD-3-Clause
#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <utility>

namespace vps::bench {

bool Row::isMet() const {
  return std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return f.is_met; });
}

std::string text(const char* format, ...) {
  char buffer[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(buffer, sizeof buffer, format, args);
  va_end(args);
  return buffer;
}

Figure atMost(const std::string& what, double value, double bound, double scale, const std::string& unit) {
  return {text("%s %.3g %s", what.c_str(), value * scale, unit.c_str()),
          text("<= %.3g %s", bound * scale, unit.c_str()), value <= bound, what};
}

Figure within(const std::string& what, double value, double wanted, double tolerance, double scale,
              const std::string& unit) {
  return {text("%s %.5g %s", what.c_str(), value * scale, unit.c_str()),
          text("%.5g +- %.3g %s", wanted * scale, tolerance * scale, unit.c_str()),
          std::abs(value - wanted) <= tolerance, what};
}

Figure holds(const std::string& claim, bool is_met) {
  return {is_met ? claim : "not: " + claim, claim, is_met};
}

Figure reported(const std::string& what, double value, double scale, const std::string& unit) {
  return {text("%s %.3g %s", what.c_str(), value * scale, unit.c_str()), "", true, what};
}

namespace {

void printRow(const Row& row, const char* verdict) {
  std::string ours, bound;
  for (const Figure& f : row.figures) {
    ours += (ours.empty() ? "" : ", ") + f.text + (f.is_met ? "" : " (!)");
    if (!f.bound.empty() && f.bound != f.text) bound += (bound.empty() ? "" : ", ") + f.bound;
  }
  std::printf("%s | %s | %s | %s | %s\n", row.name.c_str(), row.mode.c_str(), ours.c_str(), bound.c_str(),
              verdict);
  if (!row.note.empty()) std::printf("    %s\n", row.note.c_str());
}

}  // namespace

void Table::add(Row row) {
  printRow(row, row.isMet() ? "met" : "NOT MET");
  std::fflush(stdout);
  const std::clock_t now = std::clock();
  rows_.push_back({std::move(row), true, static_cast<double>(now - last_) / CLOCKS_PER_SEC});
  last_ = now;
}

void Table::addRival(Row row) {
  printRow(row, "-");
  std::fflush(stdout);
  rows_.push_back({std::move(row), false, 0});
  last_ = std::clock();
}

// Figures without a name, such as claims, are distinguished by their bound.
void Table::write(const Entry& entry, bool is_case_met) {
  double cpu_s = entry.cpu_s;
  for (const Figure& f : entry.row.figures) {
    const std::string name = f.name.empty() ? f.bound : f.name;
    const char* verdict = f.bound.empty() ? test::kReported
                          : f.is_met      ? test::kMet
                          : is_case_met   ? "by another mode"
                                          : test::kFailed;
    file.add("peers " + entry.row.name + ", " + entry.row.mode + ": " + name, f.bound, f.text, verdict,
             std::exchange(cpu_s, 0));
  }
}

int Table::print() {
  std::map<std::string, bool> case_met;
  for (const Entry& e : rows_)
    if (e.is_judged) case_met[e.row.name] |= e.row.isMet();
  std::printf("\ncase | mode | ours | bound | met\n");
  for (const Entry& e : rows_)
    printRow(e.row, !e.is_judged              ? "-"
                    : e.row.isMet()           ? "met"
                    : case_met.at(e.row.name) ? "no (another mode does)"
                                              : "NOT MET");
  for (const Entry& e : rows_)
    if (e.is_judged) write(e, case_met.at(e.row.name));
  return static_cast<int>(
      std::count_if(case_met.begin(), case_met.end(), [](const auto& c) { return !c.second; }));
}

}  // namespace vps::bench
