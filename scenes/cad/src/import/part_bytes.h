// SPDX-License-Identifier: BSD-3-Clause
// Parts as bytes, for another process or another run of this program on the same machine.
//
// One transfer() for each type serves both directions, so that reading and writing cannot disagree:
// `io(pointer, size)` copies the bytes of a value out or in. Values keep their layout in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "import/readers.h"

namespace vps::scenes::import {

class ToBytes {
 public:
  void operator()(const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); }
  std::string out;
};

/// Thrown for bytes that end early or hold a value that no part has.
struct Damaged {};

class FromBytes {
 public:
  explicit FromBytes(const std::string& bytes) : bytes_(bytes) {}
  void operator()(void* data, std::size_t size) {
    if (size > bytes_.size() - at_) throw Damaged();
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  void operator()(bool* value, std::size_t) {
    unsigned char byte = 0;
    (*this)(&byte, sizeof byte);
    if (byte > 1) throw Damaged();
    *value = byte == 1;
  }
  [[nodiscard]] bool isAtEnd() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Io, class T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void transfer(Io& io, T& value) {
  io(&value, sizeof value);
}

/// A string, or a vector of values without pointers.
template <class Io, class Array>
void transferArray(Io& io, Array& values) {
  std::uint64_t count = values.size();
  transfer(io, count);
  values.resize(std::size_t(count));
  io(static_cast<void*>(values.data()), values.size() * sizeof(values[0]));
}

template <class Io, class T, class Each>
void transferEach(Io& io, std::vector<T>& values, Each each) {
  std::uint64_t count = values.size();
  transfer(io, count);
  values.resize(std::size_t(count));
  for (T& value : values) each(value);
}

template <class Io>
void transferLines(Io& io, std::vector<std::string>& lines) {
  transferEach(io, lines, [&](std::string& line) { transferArray(io, line); });
}

template <class Io>
void transfer(Io& io, Mesh& mesh) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  auto& [vertices, triangles] = mesh;
  transferArray(io, vertices);
  transferArray(io, triangles);
}

template <class Io>
void transfer(Io& io, FaceColors& colors) {
  auto& [palette, of_triangle] = colors;
  transferArray(io, palette);
  transferArray(io, of_triangle);
}

template <class Io>
void transfer(Io& io, RawPart& part) {
  auto& [name, mesh, X_WP, color, deviation_m, note, within, rounding, face_colors] = part;
  transferArray(io, name);
  transfer(io, mesh);
  io(X_WP.data(), 16 * sizeof(double));
  io(color.data(), sizeof color);
  transfer(io, deviation_m);
  transferArray(io, note);
  transferLines(io, within);
  transfer(io, rounding);
  transfer(io, face_colors);
}

template <class Io>
void transfer(Io& io, RawCad& cad) {
  auto& [parts, warnings, unit_m, states_unit, open_shapes, missing] = cad;
  transferEach(io, parts, [&](RawPart& part) { transfer(io, part); });
  transferLines(io, warnings);
  transfer(io, unit_m);
  transfer(io, states_unit);
  transfer(io, open_shapes);
  transferArray(io, missing);
}

template <class Io>
void transfer(Io& io, ImportedPart& part) {
  auto& [name, mesh, X_WP, color, deflection_m, note, within, rounding_m, face_colors] = part;
  transferArray(io, name);
  transfer(io, mesh);
  io(X_WP.R.data(), 9 * sizeof(double));
  io(X_WP.p.data(), 3 * sizeof(double));
  io(color.data(), sizeof color);
  bool has_deflection = deflection_m.has_value();
  double value_m = deflection_m.value_or(0);
  transfer(io, has_deflection);
  transfer(io, value_m);
  deflection_m = has_deflection ? std::optional(value_m) : std::nullopt;
  transferArray(io, note);
  transferLines(io, within);
  transfer(io, rounding_m);
  transfer(io, face_colors);
}

/// The key under which the parts of a file are kept between runs: the file's bytes, the settings, and the
/// versions of the reader and of this code. Empty for a format without FormatRow::version, for a STEP file
/// that names other files, and for a file that cannot be read.
std::string madeFrom(const std::string& file, const FileFormat& format, const ImportSettings& settings);

/// Parts and warnings as bytes, from which readKeptBytes() restores every bit on the same machine.
std::string keptBytes(const ImportedCad& cad);
/// Sets parts and warnings; false for bytes of another kind, which leave `cad` unchanged.
bool readKeptBytes(const std::string& bytes, ImportedCad& cad);

}  // namespace vps::scenes::import
