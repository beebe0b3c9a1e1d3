// SPDX-License-Identifier: BSD-3-Clause
// vps_stability: the table of contact at its extremes. Exits 1 if a required value fails, 2 for an unknown
// option.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "rows.h"
#include "table.h"

namespace {

int usage() {
  std::printf(
      "usage: vps_stability [--short] [--thorough] [--rows=a,b] [--mode=constraint|penalty|stock] "
      "[--values=x,y] [--tsv=FILE]\n"
      "  --short     what must hold, without the search for limits\n"
      "  --thorough  hours at rest instead of seconds\n"
      "  --values    these instead of the rows' own\n"
      "  --tsv       also writes the rows to this file\n"
      "rows:");
  for (const vps::stability::Row& row : vps::stability::allRows()) std::printf(" %s", row.key.c_str());
  std::printf("\n");
  return 2;
}

std::vector<double> numbers(const char* text) {
  std::vector<double> values;
  for (char* end = nullptr; *text; text = *end == ',' ? end + 1 : end) {
    values.push_back(std::strtod(text, &end));
    if (end == text) return {};
  }
  return values;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vps::stability;
  Options options;
  vps::test::TableRows rows_file;
  std::string wanted;
  std::vector<double> values;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "--short") {
      options.is_short = true;
    } else if (arg == "--thorough") {
      options.is_thorough = true;
    } else if (arg.rfind("--rows=", 0) == 0) {
      wanted = "," + arg.substr(7) + ",";
    } else if (arg.rfind("--values=", 0) == 0) {
      values = numbers(argv[i] + 9);
    } else if (arg == "--mode=constraint") {
      options.modes = {Mode::Constraint};
    } else if (arg == "--mode=penalty") {
      options.modes = {Mode::Penalty};
    } else if (arg == "--mode=stock") {
      options.modes = {Mode::ConstraintStock};
    } else if (arg.rfind("--tsv=", 0) == 0) {
      if (!rows_file.open(arg.substr(6))) return usage();
    } else {
      return usage();
    }
  }
  std::vector<Row> rows;
  for (Row& row : allRows()) {
    if (!wanted.empty() && wanted.find("," + row.key + ",") == std::string::npos) continue;
    if (!values.empty()) row.ladder = values, row.promised = values.size();
    rows.push_back(std::move(row));
  }
  if (rows.empty()) return usage();
  return printTable(rows, options, rows_file) == 0 ? 0 : 1;
}
