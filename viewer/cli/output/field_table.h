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
  std::vector<std::string> heads;
  for (const ColumnCell& heading : columnHeadings(fields, Medium::Terminal))
    heads.push_back((heading.is_left ? "<" : "") + heading.text);
  Table table(heads);
  for (const Struct& of : structs) {
    std::vector<std::string> cells;
    for (ColumnCell& cell : columnCells(of, fields, Medium::Terminal, fixed))
      cells.push_back(std::move(cell.text));
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace vps::viewer
