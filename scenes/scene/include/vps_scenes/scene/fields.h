// SPDX-License-Identifier: BSD-3-Clause
// Field tables: a row for each member of a struct of settings or results. The readers and writers of TOML,
// archive, JSON, CSV and documentation iterate over the rows, so a new setting or number needs a member, a
// row, and its use.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "vps_scenes/export.h"

namespace vps::scenes {

/// Notation of a number in a scene file. Values in members and in JSON are always in SI units.
enum class Quantity {
  Plain,      ///< the member's own unit, which the key names
  Length,     ///< key "voxel": in the file's unit, or text with a unit ("20um"); in JSON "voxel_m"
  Angle,      ///< key "tilt_deg": degrees; in JSON "tilt_rad"
  Megabytes,  ///< key "memory_MB"; in JSON "memory_bytes"
};

/// The values a number may take; both ends are included unless is_open_min.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool is_open_min = false;

  /// True for a finite value within the range.
  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    return (is_open_min ? value > min : value >= min) && value <= max;
  }
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{.min = 0, .is_open_min = true};
inline constexpr Range kNotNegative{.min = 0};

struct FieldTraits {
  Quantity quantity = Quantity::Plain;
  Range range = kAny;                  ///< allowed values of a setting
  int since = 1;                       ///< version of the scene archive that first holds the setting
  std::string_view type = {};          ///< type for the documentation; empty: the member's type
  std::string_view default_text = {};  ///< default for the documentation; empty: the struct's
  std::string_view zero_word = {};     ///< word for the integer 0 in a scene file; empty: none
};

/// One setting or one reported number.
template <class Get>
struct Field {
  std::string_view key;
  Get get;  ///< member pointer, or a function of the struct; called by std::invoke
  std::string_view meaning;
  FieldTraits traits;
};

/// A column of a table for readers, on the terminal or on a page.
template <class Struct>
struct TableColumn {
  std::string_view heading = {};  ///< "<part", "clearance [um]"; '<': aligned left; empty: no column
  double per_SI = 1;              ///< units of the heading per SI unit
  int digits = 2;                 ///< digits after the decimal point
  /// Columns are ordered by their places; columns with equal places keep the order of their rows.
  int place = 0;
  bool (*is_shown)(const Struct&) = nullptr;     ///< false: the cell is empty; null: always shown
  std::string (*text)(const Struct&) = nullptr;  ///< text of the cell; null: the value itself
  bool (*is_bad)(const Struct&) = nullptr;       ///< the page marks the cell as a fault; null: never
};

/// How a number appears outside of JSON.
template <class Struct>
struct Shown {
  TableColumn<Struct> column = {};
  TableColumn<Struct> page_column = {};  ///< the column on a page, where it differs; no heading: as `column`
  /// Place of the number's line in a CSV file with a line for each number, ordered as TableColumn::place; 0:
  /// no line.
  int csv_place = 0;
  /// Key of the row in the same table that bounds the number's error; empty: the CSV file states no bound.
  std::string_view error = {};
  /// Names of the elements of a list, each of which has a line of its own in the CSV file.
  std::span<const std::string_view> elements = {};
};

/// A field that tables for readers or a CSV file show as well.
template <class Struct, class Get>
struct ShownField : Field<Get> {
  Shown<Struct> shown;
};

/// An object within the struct's object; with an empty key, its rows are rows of the outer object. The object
/// is left out when `get` returns a null pointer or an empty optional.
template <class Get, class Rows>
struct Group {
  std::string_view key;
  Get get;
  Rows rows;
  std::string_view meaning;  ///< text for all rows together; empty: each row has its own text
};

/// A list of objects.
template <class Get, class Rows>
struct List {
  std::string_view key;
  Get get;  ///< getter of a container of structs, as Field::get
  Rows rows;
};

/// Lists, one for each row, with one value for each struct of a container.
template <class Get, class Rows>
struct Columns {
  Get get;
  Rows rows;
};

/// A key of a scene file that loadScene() reads without the field table. A key without a meaning is
/// documented elsewhere.
struct Key {
  std::string_view key, type = {}, default_text = {}, meaning = {};
};

template <class Get>
constexpr Field<Get> field(std::string_view key, Get get, std::string_view meaning, FieldTraits traits = {}) {
  return {key, get, meaning, traits};
}
/// A field with the columns and lines of `how`: shown<CheckedPair>(field(...), {...}).
template <class Struct, class Get>
constexpr ShownField<Struct, Get> shown(const Field<Get>& of, const Shown<Struct>& how) {
  return {of, how};
}
template <class Get, class Rows>
constexpr Group<Get, Rows> group(std::string_view key, Get get, Rows rows, std::string_view meaning = {}) {
  return {key, get, rows, meaning};
}
/// A group whose rows are members of the struct itself.
template <class Rows>
constexpr Group<std::identity, Rows> object(std::string_view key, Rows rows, std::string_view meaning = {}) {
  return {key, {}, rows, meaning};
}
template <class Get, class Rows>
constexpr List<Get, Rows> list(std::string_view key, Get get, Rows rows) {
  return {key, get, rows};
}
template <class Get, class Rows>
constexpr Columns<Get, Rows> columns(Get get, Rows rows) {
  return {get, rows};
}

/// Getter of a member of a member.
template <class First, class Second>
struct Path {
  First first;
  Second second;
  template <class Struct>
  constexpr decltype(auto) operator()(Struct& of) const {
    return std::invoke(second, std::invoke(first, of));
  }
};
template <class First, class Second>
constexpr Path<First, Second> path(First first, Second second) {
  return {first, second};
}

/// Getter of the struct itself if its flag is set, else of a null pointer.
template <class Struct>
struct When {
  bool Struct::*flag;
  constexpr const Struct* operator()(const Struct& of) const { return of.*flag ? &of : nullptr; }
};
template <class Struct>
constexpr When<Struct> when(bool Struct::*flag) {
  return {flag};
}

/// Calls `visit` with each row of a table.
template <class Rows, class Visit>
constexpr void forEachRow(const Rows& rows, Visit&& visit) {
  std::apply([&](const auto&... row) { (visit(row), ...); }, rows);
}

/// The key of a number in JSON and CSV, where numbers are in SI units.
inline std::string siKey(std::string_view key, Quantity quantity) {
  switch (quantity) {
    case Quantity::Plain:
      return std::string(key);
    case Quantity::Length:
      return std::string(key) + "_m";
    case Quantity::Angle:
      return std::string(key.substr(0, key.rfind('_'))) + "_rad";
    case Quantity::Megabytes:
      return std::string(key.substr(0, key.rfind('_'))) + "_bytes";
  }
  return {};
}
template <class Get>
std::string siKey(const Field<Get>& field) {
  return siKey(field.key, field.traits.quantity);
}

/// The object that a group's getter returned; null if the group is left out.
template <class Struct>
constexpr const Struct* pointerTo(const Struct* of) {
  return of;
}
template <class Struct>
constexpr const Struct* pointerTo(const std::optional<Struct>& of) {
  return of ? &*of : nullptr;
}
template <class Struct>
constexpr const Struct* pointerTo(const Struct& of) {
  return &of;
}

/// The number of values of an enum of settings. The words of an enum's values are toText() of 0, 1, ...
template <class Enum>
inline constexpr int kValueCount = 0;

// --- Check that a table has a row for every member

struct VPS_SCENES_API AnyValue {
  template <class T>
  operator T() const noexcept;  // NOLINT: named in a requires-expression, never called
};

/// The number of members of an aggregate.
template <class Struct, class... Given>
consteval std::size_t memberCount() {
  if constexpr (requires { Struct{Given{}..., AnyValue{}}; })
    return memberCount<Struct, Given..., AnyValue>();
  else
    return sizeof...(Given);
}

template <class Struct>
struct RowCounter {
  std::size_t count = 0;

  template <class Member>
  constexpr void operator()(const Field<Member Struct::*>&) {
    ++count;
  }
  template <class Member, class Rows>
  constexpr void operator()(const Group<Member Struct::*, Rows>&) {
    ++count;
  }
  template <class Member, class Rows>
  constexpr void operator()(const List<Member Struct::*, Rows>&) {
    ++count;
  }
  template <class Rows>
  constexpr void operator()(const Group<std::identity, Rows>& group) {
    std::apply([this](const auto&... row) { ((*this)(row), ...); }, group.rows);
  }
  constexpr void operator()(const Key&) {}
};

/// True if the tables together have a row for each member of the struct, except for `by_hand` members that
/// other code handles.
template <class Struct, std::size_t by_hand = 0, class... Tables>
consteval bool coversAllMembers(const Tables&... tables) {
  RowCounter<Struct> counter;
  (std::apply([&](const auto&... row) { (counter(row), ...); }, tables), ...);
  return counter.count + by_hand == memberCount<Struct>();
}

}  // namespace vps::scenes
