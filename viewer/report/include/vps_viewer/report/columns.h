// SPDX-License-Identifier: BSD-3-Clause
// Field tables as tables for readers: the columns of scenes::ShownField, on the terminal and on a page.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/scene/fields.h"

namespace vps::viewer {

enum class Medium { Terminal, Page };

/// A heading or a cell, as plain text.
struct ColumnCell {
  int place = 0;  ///< TableColumn::place
  std::string text;
  bool is_left = false;  ///< the column is aligned left
  bool is_bad = false;   ///< TableColumn::is_bad
};

/// Writes a number with this many digits after the decimal point.
using WriteNumber = std::string (*)(double value, int digits);

/// Calls visit(row, column) for each row with a column in the medium.
template <class Rows, class Visit>
void forEachColumn(const Rows& rows, Medium medium, const Visit& visit) {
  scenes::forEachRow(rows, [&](const auto& row) {
    if constexpr (requires { row.shown; }) {
      const bool is_own = medium == Medium::Page && !row.shown.page_column.heading.empty();
      const auto& column = is_own ? row.shown.page_column : row.shown.column;
      if (!column.heading.empty()) visit(row, column);
    }
  });
}

template <class T, class Struct>
std::string cellText(const T& value, const scenes::TableColumn<Struct>& column, WriteNumber write) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (std::is_enum_v<T>) {
    return toText(value);
  } else if constexpr (std::is_same_v<T, Vec3>) {
    std::string out;
    for (int i = 0; i < 3; ++i)
      out.append(i > 0 ? ", " : "").append(write(column.per_SI * value[i], column.digits));
    return out;
  } else if constexpr (std::is_floating_point_v<T>) {
    return write(column.per_SI * value, column.digits);
  } else {
    return std::to_string(value);
  }
}

/// The headings of a table's columns, in their order.
template <class Rows>
std::vector<ColumnCell> columnHeadings(const Rows& rows, Medium medium) {
  std::vector<ColumnCell> cells;
  forEachColumn(rows, medium, [&](const auto&, const auto& column) {
    const bool is_left = column.heading.starts_with('<');
    cells.push_back({column.place, std::string(column.heading.substr(is_left ? 1 : 0)), is_left});
  });
  std::ranges::stable_sort(cells, {}, &ColumnCell::place);
  return cells;
}

/// The cells of a struct, one for each of columnHeadings().
template <class Struct, class Rows>
std::vector<ColumnCell> columnCells(const Struct& of, const Rows& rows, Medium medium, WriteNumber write) {
  std::vector<ColumnCell> cells;
  forEachColumn(rows, medium, [&](const auto& row, const auto& column) {
    ColumnCell& cell = cells.emplace_back();
    cell.place = column.place;
    cell.is_left = column.heading.starts_with('<');
    cell.is_bad = column.is_bad != nullptr && column.is_bad(of);
    if (column.is_shown != nullptr && !column.is_shown(of)) return;
    cell.text = column.text != nullptr ? column.text(of) : cellText(std::invoke(row.get, of), column, write);
  });
  std::ranges::stable_sort(cells, {}, &ColumnCell::place);
  return cells;
}

}  // namespace vps::viewer
