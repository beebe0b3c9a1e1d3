// SPDX-License-Identifier: BSD-3-Clause
// CSV (RFC 4180), and field tables as CSV.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/fields.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// One line of CSV with its line end. Cells with commas, quotes or line breaks are quoted.
VPS_VIEWER_API std::string csvLine(const std::vector<std::string>& cells);
/// The shortest text that reads back as the same value; "NaN" for a value that is not finite.
VPS_VIEWER_API std::string csvNumber(double value);

// --- Columns of one value. A vector with the key "force_N" has the columns "force_x_N", "force_y_N",
// "force_z_N"; a pose with the key "part" has "part_x_m" to "part_z_m" and "part_qx" to "part_qw".

VPS_VIEWER_API void addColumns(std::vector<std::string>& columns, const std::string& key, const Vec3*);
VPS_VIEWER_API void addColumns(std::vector<std::string>& columns, const std::string& key, const Pose*);
inline void addColumns(std::vector<std::string>& columns, const std::string& key, const void*) {
  columns.push_back(key);
}
VPS_VIEWER_API void addCells(std::vector<std::string>& cells, const Vec3& v);
VPS_VIEWER_API void addCells(std::vector<std::string>& cells, const Pose& X);
template <class T>
void addCells(std::vector<std::string>& cells, const T& x) {
  if constexpr (std::is_same_v<T, std::string>)
    cells.push_back(x);
  else if constexpr (std::is_enum_v<T>)
    cells.emplace_back(toText(x));
  else if constexpr (std::is_floating_point_v<T>)
    cells.push_back(csvNumber(x));
  else
    cells.push_back(std::to_string(x));  // a bool is 0 or 1
}

// --- Field tables: the columns of a nested object have the object's key as prefix, as in
// "probe_force_error".

template <class Struct, class Get>
void addRowColumns(std::vector<std::string>& columns, const std::string& prefix,
                   const scenes::Field<Get>& row) {
  using Value = std::remove_cvref_t<std::invoke_result_t<Get, const Struct&>>;
  addColumns(columns, prefix + siKey(row), static_cast<const Value*>(nullptr));
}
template <class Struct, class Get, class Rows>
void addRowColumns(std::vector<std::string>& columns, const std::string& prefix,
                   const scenes::Group<Get, Rows>& group) {
  using Inner = std::remove_cvref_t<decltype(*scenes::pointerTo(
      std::invoke(group.get, std::declval<const Struct&>())))>;
  const std::string key(group.key);
  scenes::forEachRow(group.rows, [&](const auto& row) {
    addRowColumns<Inner>(columns, key.empty() ? prefix : prefix + key + "_", row);
  });
}

template <class Struct, class Rows>
std::vector<std::string> csvColumns(const Rows& rows) {
  std::vector<std::string> columns;
  scenes::forEachRow(rows, [&](const auto& row) { addRowColumns<Struct>(columns, "", row); });
  return columns;
}

template <class Struct, class Get>
void addRowCells(std::vector<std::string>& cells, const Struct& of, const scenes::Field<Get>& row) {
  addCells(cells, std::invoke(row.get, of));
}
/// The cells of a group. If the group is absent, all its cells are empty.
template <class Struct, class Get, class Rows>
void addRowCells(std::vector<std::string>& cells, const Struct& of, const scenes::Group<Get, Rows>& group) {
  const auto* inner = scenes::pointerTo(std::invoke(group.get, of));
  using Inner = std::remove_cvref_t<decltype(*inner)>;
  if (inner == nullptr)
    cells.resize(cells.size() + csvColumns<Inner>(group.rows).size());
  else
    scenes::forEachRow(group.rows, [&](const auto& row) { addRowCells(cells, *inner, row); });
}

/// A table as CSV: a header line, and a line for each struct.
template <class Struct, class Rows>
std::string toCsv(const std::vector<Struct>& structs, const Rows& rows) {
  std::string out = csvLine(csvColumns<Struct>(rows));
  std::vector<std::string> cells;
  for (const Struct& of : structs) {
    cells.clear();
    scenes::forEachRow(rows, [&](const auto& row) { addRowCells(cells, of, row); });
    out += csvLine(cells);
  }
  return out;
}

// --- Field tables as lines: one line for each number of scenes::ShownField that has a place in the file.

struct CsvNumber {
  int place = 0;            ///< Shown::csv_place
  std::size_t element = 0;  ///< in a list of numbers
  std::string object;       ///< key of the nested object that holds the number; empty: the struct itself
  std::string quantity;     ///< the number's key, and the name of its element: "play_m +x"
  double value = 0;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no bound is stated
};

/// The numbers of a field as a list; empty if the field holds no number.
template <class T>
std::vector<double> asNumbers(const T& value) {
  if constexpr (std::is_same_v<T, std::vector<double>>)
    return value;
  else if constexpr (std::is_arithmetic_v<T>)
    return {static_cast<double>(value)};
  else
    return {};
}

/// The numbers of the row with this key; empty if no row has it.
template <class Struct, class Rows>
std::vector<double> numbersWithKey(const Struct& of, const Rows& rows, std::string_view key) {
  std::vector<double> found;
  scenes::forEachRow(rows, [&](const auto& row) {
    if constexpr (requires { row.traits; })
      if (row.key == key) found = asNumbers(std::invoke(row.get, of));
  });
  return found;
}

template <class Struct, class Rows>
void addCsvNumbers(std::vector<CsvNumber>& out, const std::string& object, const Struct& of,
                   const Rows& rows) {
  scenes::forEachRow(rows, [&](const auto& row) {
    if constexpr (requires { row.shown; }) {
      if (row.shown.csv_place == 0) return;
      const std::vector<double> values = asNumbers(std::invoke(row.get, of)),
                                errors = numbersWithKey(of, rows, row.shown.error);
      for (std::size_t i = 0; i < values.size(); ++i) {
        CsvNumber& number = out.emplace_back();
        number.place = row.shown.csv_place;
        number.element = i;
        number.object = object;
        number.quantity = siKey(row);
        if (!row.shown.elements.empty()) number.quantity.append(" ").append(row.shown.elements[i]);
        number.value = values[i];
        if (i < errors.size()) number.error = errors[i];
      }
    } else if constexpr (requires {
                           row.rows;
                           row.meaning;
                         }) {  // a group
      if (const auto* inner = scenes::pointerTo(std::invoke(row.get, of)))
        addCsvNumbers(out, std::string(row.key), *inner, row.rows);
    }
  });
}

/// The numbers of a struct that have a line in a CSV file, in the order of the lines: by place, and within
/// one place by element, then as the rows.
template <class Struct, class Rows>
std::vector<CsvNumber> csvNumbers(const Struct& of, const Rows& rows) {
  std::vector<CsvNumber> out;
  addCsvNumbers(out, "", of, rows);
  std::ranges::stable_sort(out, {},
                           [](const CsvNumber& number) { return std::pair(number.place, number.element); });
  return out;
}

/// Writes the time series as CSV: a header line, then one row per sample, with SI units in the column names.
/// The folder must exist. Throws LoadError when the file cannot be written.
VPS_VIEWER_API void writeTraceCsv(const std::vector<scenes::TraceRow>& trace, const std::string& file);

}  // namespace vps::viewer
