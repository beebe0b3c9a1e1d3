// SPDX-License-Identifier: BSD-3-Clause
// Field tables as tables for readers: the columns of scenes::ShownField, on the terminal and on a page.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
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

/// Whether a column is written in millimetres instead of micrometres, in the order of the rows; empty: none
/// is.
using InMillimetres = std::vector<bool>;

/// The headings of a table's columns, in their order.
template <class Rows>
std::vector<ColumnCell> columnHeadings(const Rows& rows, Medium medium, const InMillimetres& in_mm = {}) {
  std::vector<ColumnCell> cells;
  forEachColumn(rows, medium, [&](const auto&, const auto& column) {
    const bool is_left = column.heading.starts_with('<'), is_mm = !in_mm.empty() && in_mm[cells.size()];
    std::string text(column.heading.substr(is_left ? 1 : 0));
    if (is_mm) text.replace(text.find("[um]"), 4, "[mm]");
    cells.push_back({column.place, std::move(text), is_left});
  });
  std::ranges::stable_sort(cells, {}, &ColumnCell::place);
  return cells;
}

/// The cells of a struct, one for each of columnHeadings().
template <class Struct, class Rows>
std::vector<ColumnCell> columnCells(const Struct& of, const Rows& rows, Medium medium, WriteNumber write,
                                    const InMillimetres& in_mm = {}) {
  std::vector<ColumnCell> cells;
  forEachColumn(rows, medium, [&](const auto& row, auto column) {
    if (!in_mm.empty() && in_mm[cells.size()]) {
      column.per_SI *= 1e-3;
      column.digits += 2;
    }
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

/// The columns of these structs that are written in millimetres: those in micrometres with a number of a
/// metre or more.
template <class Struct, class Rows>
InMillimetres columnsInMillimetres(const std::vector<Struct>& structs, const Rows& rows, Medium medium) {
  constexpr double kLong_m = 1;
  InMillimetres out;
  forEachColumn(rows, medium, [&](const auto& row, const auto& column) {
    bool is_long = false;
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(std::invoke(row.get, structs.front()))>>)
      if (column.heading.find("[um]") != std::string_view::npos && column.text == nullptr)
        is_long = std::ranges::any_of(structs, [&](const Struct& of) {
          return (column.is_shown == nullptr || column.is_shown(of)) &&
                 std::isfinite(std::invoke(row.get, of)) && std::abs(std::invoke(row.get, of)) >= kLong_m;
        });
    out.push_back(is_long);
  });
  return out;
}

/// A whole table: its headings, and a row for each struct.
struct ColumnTable {
  std::vector<ColumnCell> headings;
  std::vector<std::vector<ColumnCell>> rows;
};
template <class Struct, class Rows>
ColumnTable columnTable(const std::vector<Struct>& structs, const Rows& rows, Medium medium,
                        WriteNumber write) {
  const InMillimetres in_mm = columnsInMillimetres(structs, rows, medium);
  ColumnTable table{columnHeadings(rows, medium, in_mm), {}};
  for (const Struct& of : structs) table.rows.push_back(columnCells(of, rows, medium, write, in_mm));
  return table;
}

}  // namespace vps::viewer
