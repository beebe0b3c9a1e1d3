// SPDX-License-Identifier: BSD-3-Clause
// A table on the terminal, with the columns that a field table gives the terminal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "output/table.h"
#include "vps_viewer/report/columns.h"

namespace vps::viewer {

/// A row for each struct.
template <class Struct, class Rows>
std::string fieldTable(const std::vector<Struct>& structs, const Rows& fields) {
  ColumnTable columns = columnTable(structs, fields, Medium::Terminal, fixed);
  std::vector<std::string> heads;
  for (const ColumnCell& heading : columns.headings)
    heads.push_back((heading.is_left ? "<" : "") + heading.text);
  Table table(heads);
  for (std::vector<ColumnCell>& row : columns.rows) {
    std::vector<std::string> cells;
    for (ColumnCell& cell : row) cells.push_back(std::move(cell.text));
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace vps::viewer
