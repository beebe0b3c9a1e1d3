// SPDX-License-Identifier: BSD-3-Clause
// Writes the rows of a field table as JSON. Includes nlohmann/json, which is slow to compile, so only
// json_out.cpp, study_log.cpp and study_on_dask.cpp include this header.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vps/mesh.h"
#include "vps_scenes/scene/fields.h"

namespace vps::viewer {

// An ordered_json keeps its keys in the order in which they were added.
using Json = nlohmann::ordered_json;

inline Json toValue(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Json toValue(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline Json toValue(const Box& box) {
  return {toValue(box.min), toValue(box.max)};
}
inline Json toValue(const std::vector<Vec3>& list) {
  Json out = Json::array();
  for (const Vec3& v : list) out.push_back(toValue(v));
  return out;
}
inline Json toValue(const std::optional<double>& x) {
  return x ? Json(*x) : Json(nullptr);
}
inline Json toValue(const std::vector<std::pair<std::string, std::uint64_t>>& counts) {
  Json out = Json::object();
  for (const auto& [key, count] : counts) out[key] = count;
  return out;
}
template <class T>
Json toValue(const T& x) {
  if constexpr (std::is_enum_v<T>)
    return toText(x);
  else
    return x;
}

template <class Struct, class Rows>
void addFields(Json& out, const Struct& of, const Rows& rows);

template <class Struct, class Rows>
Json toObject(const Struct& of, const Rows& rows) {
  Json out = Json::object();
  addFields(out, of, rows);
  return out;
}

template <class Struct, class Get>
void addRow(Json& out, const Struct& of, const scenes::Field<Get>& row) {
  out[siKey(row)] = toValue(std::invoke(row.get, of));
}
template <class Struct, class Get, class Rows>
void addRow(Json& out, const Struct& of, const scenes::Group<Get, Rows>& group) {
  const auto* inner = scenes::pointerTo(std::invoke(group.get, of));
  if (inner == nullptr) return;
  if (group.key.empty())
    addFields(out, *inner, group.rows);
  else
    out[std::string(group.key)] = toObject(*inner, group.rows);
}
template <class Struct, class Get, class Rows>
void addRow(Json& out, const Struct& of, const scenes::List<Get, Rows>& list) {
  Json objects = Json::array();
  for (const auto& inner : std::invoke(list.get, of)) objects.push_back(toObject(inner, list.rows));
  out[std::string(list.key)] = std::move(objects);
}
template <class Struct, class Get, class Rows>
void addRow(Json& out, const Struct& of, const scenes::Columns<Get, Rows>& columns) {
  scenes::forEachRow(columns.rows, [&](const auto& row) {
    Json& values = out[siKey(row)] = Json::array();
    for (const auto& inner : std::invoke(columns.get, of))
      values.push_back(toValue(std::invoke(row.get, inner)));
  });
}

/// Adds the rows of a table to an object.
template <class Struct, class Rows>
void addFields(Json& out, const Struct& of, const Rows& rows) {
  scenes::forEachRow(rows, [&](const auto& row) { addRow(out, of, row); });
}

}  // namespace vps::viewer
