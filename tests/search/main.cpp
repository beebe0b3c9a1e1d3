// SPDX-License-Identifier: BSD-3-Clause
// vps_search: random cases of sharp-edged parts, and how deep they overlap. Exits 1 if a case exceeds the
// bound, 2 for an unknown option.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "search_table.h"

namespace {

using vps::search::SearchOptions;

int usage() {
  std::printf(
      "usage: vps_search [--minutes M | --seconds-simulated S | --runs N] [--family a,b] [--step-ms 1,4,10]\n"
      "                  [--meshes closed,faulty] [--mode constraint|penalty] [--seed N] [--save FOLDER]\n"
      "  --minutes            of the clock, for all rows together (default 1)\n"
      "  --seconds-simulated  for each row\n"
      "  --runs               cases of each row\n"
      "  --seed               of the first case; the others count up from it (default: from the date)\n"
      "  --save               folder for cases that exceed the bound (default: out/search)\n"
      "  --tsv                a file for the rows\n"
      "  --verbose            a line for each case\n"
      "families:\n");
  for (const vps::search::Family& family : vps::search::families())
    std::printf("  %-14s %s\n", family.name, family.description);
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
      if (!vps::search::findFamily(family)) return false;
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

int main(int argc, char** argv) {
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
  return vps::search::printTable(options) ? 0 : 1;
}
