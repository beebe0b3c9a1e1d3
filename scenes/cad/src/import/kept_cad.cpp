// SPDX-License-Identifier: BSD-3-Clause
#include "import/part_bytes.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>

namespace vps::scenes::import {
namespace {

/// Incremented when reading gives other bits, or part_bytes.h changes.
constexpr std::uint32_t kKeptVersion = 3;

template <class Io>
void transferParts(Io& io, ImportedCad& cad) {
  transferEach(io, cad.parts, [&](ImportedPart& part) { transfer(io, part); });
  transferLines(io, cad.warnings);
  transfer(io, cad.states_unit);
  transferArray(io, cad.missing);
}

/// Whether all vertices and colours that the triangles refer to exist.
bool isConsistent(const ImportedPart& part) {
  const std::size_t vertices = part.mesh.vertices.size(), triangles = part.mesh.triangles.size();
  const FaceColors& colors = part.face_colors;
  return part.X_WP.isFinite() && (colors.isNone() || colors.of_triangle.size() == triangles) &&
         std::ranges::all_of(colors.of_triangle,
                             [&](std::uint32_t color) { return color < colors.palette.size(); }) &&
         std::ranges::all_of(part.mesh.triangles, [&](const auto& triangle) {
           return std::ranges::all_of(triangle, [&](std::uint32_t corner) { return corner < vertices; });
         });
}

}  // namespace

std::string madeFrom(const std::string& file, const FileFormat& format, const ImportSettings& settings) {
  if (format.row().version == nullptr) return "";
  std::ifstream in(file, std::ios::binary);
  std::string out(std::istreambuf_iterator<char>(in), {});
  // DOCUMENT_FILE [ISO 10303-203 and 214] refers to parts in other files.
  if (!in || out.empty() || out.find("DOCUMENT_FILE") != std::string::npos) return "";
  ToBytes io;
  auto version = kKeptVersion;
  transfer(io, version);
  for (std::string text : {format.name, format.row().version(), stem(file)}) transferArray(io, text);
  double unit_m = settings.unit_m.value_or(0), deflection_m = settings.deflection_m,
         angle_rad = settings.angle_rad, coarsest_m = settings.coarsest_m;
  std::uint64_t most_triangles = settings.most_triangles;
  for (double* value : {&unit_m, &deflection_m, &angle_rad, &coarsest_m}) transfer(io, *value);
  transfer(io, most_triangles);
  out += io.out;
  return out;
}

std::string keptBytes(const ImportedCad& cad) {
  ToBytes io;
  ImportedCad copy = cad;  // transfer() needs values that it may change
  transferParts(io, copy);
  return std::move(io.out);
}

bool readKeptBytes(const std::string& bytes, ImportedCad& cad) {
  ImportedCad found;
  try {
    FromBytes io(bytes);
    transferParts(io, found);
    if (!io.isAtEnd() || found.parts.empty() || !std::ranges::all_of(found.parts, isConsistent)) return false;
  } catch (const Damaged&) {
    return false;
  } catch (const std::length_error&) {
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }
  cad.parts = std::move(found.parts);
  cad.warnings = std::move(found.warnings);
  cad.states_unit = found.states_unit;
  cad.missing = std::move(found.missing);
  return true;
}

}  // namespace vps::scenes::import
