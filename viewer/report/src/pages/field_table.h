// SPDX-License-Identifier: BSD-3-Clause
// A table of a page, with the columns that a field table gives the page.
#pragma once

#include <string>
#include <vector>

#include "files/html.h"
#include "vps_viewer/report/columns.h"

namespace vps::viewer {

/// A row for each struct.
template <class Struct, class Rows>
std::string fieldTableOnPage(const std::vector<Struct>& structs, const Rows& fields) {
  const auto inPageUnits = [](std::string heading) {  // the terminal writes "um" and "mm3"
    if (const std::size_t at = heading.find("[um]"); at != std::string::npos) heading.replace(at, 4, "[µm]");
    if (const std::size_t at = heading.find("mm3"); at != std::string::npos) heading.replace(at, 3, "mm³");
    return heading;
  };
  const WriteNumber write = [](double value, int digits) {
    return html::format(value, ("%." + std::to_string(digits) + "f").c_str());
  };
  const ColumnTable columns = columnTable(structs, fields, Medium::Page, write);
  std::vector<std::string> header;
  for (const ColumnCell& heading : columns.headings) header.push_back(inPageUnits(heading.text));
  std::vector<std::vector<html::Cell>> rows;
  for (const std::vector<ColumnCell>& cells : columns.rows) {
    std::vector<html::Cell>& row = rows.emplace_back();
    for (const ColumnCell& cell : cells) {
      std::string css_class = cell.is_left ? "" : "n";
      if (cell.is_bad) css_class += css_class.empty() ? "bad" : " bad";
      row.push_back({escapeHtml(cell.text), css_class});
    }
  }
  return html::table(header, rows);
}

}  // namespace vps::viewer
