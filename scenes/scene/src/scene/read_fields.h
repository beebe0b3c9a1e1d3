// SPDX-License-Identifier: BSD-3-Clause
// Reads the rows of a field table from a table of a scene file.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_file_keys.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline void addKey(std::vector<std::string_view>& keys, const Key& row) {
  keys.push_back(row.key);
}
template <class Get>
void addKey(std::vector<std::string_view>& keys, const Field<Get>& row) {
  keys.push_back(row.key);
}
template <class Get, class Rows>
void addKey(std::vector<std::string_view>& keys, const Group<Get, Rows>& group) {
  forEachRow(group.rows, [&](const auto& row) { addKey(keys, row); });
}

/// All keys of a field table.
template <class Rows>
std::vector<std::string_view> keysOf(const Rows& rows) {
  std::vector<std::string_view> keys;
  forEachRow(rows, [&](const auto& row) { addKey(keys, row); });
  return keys;
}

/// The words of an enum, in the order of its values.
template <class Enum>
std::vector<std::string> wordsOf() {
  static_assert(kValueCount<Enum> > 0);
  std::vector<std::string> words;
  for (int i = 0; i < kValueCount<Enum>; ++i) words.emplace_back(toText(static_cast<Enum>(i)));
  return words;
}

/// Reads one value of the type of `out`; returns false when the key is absent.
inline bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits&, bool& out) {
  return keys.flag(key, out);
}
inline bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits&, std::string& out) {
  return keys.text(key, out);
}
inline bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits& traits, double& out) {
  switch (traits.quantity) {
    case Quantity::Plain:
      return keys.number(key, out, traits.range);
    case Quantity::Length:
      return keys.length(key, out, traits.range);
    case Quantity::Angle:
      return keys.angle(key, out, traits.range);
    case Quantity::Megabytes:
      if (!keys.number(key, out, traits.range)) return false;
      out *= 1e6;
      return true;
  }
  return false;
}
inline bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits& traits,
                      std::optional<double>& out) {
  double value = 0;
  if (!readValue(keys, key, traits, value)) return false;
  out = value;
  return true;
}
template <class Integer>
requires std::integral<Integer>
bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits& traits, Integer& out) {
  std::int64_t value = 0;
  if (!traits.zero_word.empty() && keys.isText(key)) {
    std::size_t zero = 0;
    keys.word(key, {std::string(traits.zero_word)}, zero);
    out = 0;
    return true;
  }
  if (!keys.integer(key, value, traits.range)) return false;
  out = static_cast<Integer>(value);
  return true;
}
template <class Enum>
requires std::is_enum_v<Enum>
bool readValue(const SceneKeys& keys, std::string_view key, const FieldTraits&, Enum& out) {
  std::size_t index = 0;
  if (!keys.word(key, wordsOf<Enum>(), index)) return false;
  out = static_cast<Enum>(index);
  return true;
}

template <class Struct>
void readRow(const SceneKeys&, Struct&, const Key&) {}
template <class Struct, class Get>
void readRow(const SceneKeys& keys, Struct& out, const Field<Get>& row) {
  readValue(keys, row.key, row.traits, std::invoke(row.get, out));
}
template <class Struct, class Get, class Rows>
void readRow(const SceneKeys& keys, Struct& out, const Group<Get, Rows>& group) {
  forEachRow(group.rows, [&](const auto& row) { readRow(keys, std::invoke(group.get, out), row); });
}

/// Reads the fields of a table into the struct; absent keys leave its members unchanged. The caller reads the
/// values of `Key` rows. Throws LoadError as SceneKeys does.
template <class Struct, class Rows>
void readFields(const SceneKeys& keys, Struct& out, const Rows& rows) {
  forEachRow(rows, [&](const auto& row) { readRow(keys, out, row); });
}

}  // namespace vps::scenes
