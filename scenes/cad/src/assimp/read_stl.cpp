// SPDX-License-Identifier: BSD-3-Clause
// Reads binary STL without colours. A scene of 10,000 parts has as many files, and a child process for each
// (child_processes.h) would copy this process's page tables each time; this reader checks all sizes and needs
// no child. assimp reads other STL files.
//
//   80 bytes    header
//   4           number n of triangles
//   50 each     normal and three corners (12 floats), 2 bytes of attribute
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

constexpr std::size_t kHeader = 84, kTriangle = 50;

template <typename T>
T valueAt(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

bool hasColor(const std::string& bytes) {
  if (bytes.substr(0, kHeader).find("COLOR=") != std::string::npos) return true;
  for (std::size_t at = kHeader; at + kTriangle <= bytes.size(); at += kTriangle)
    if ((valueAt<std::uint16_t>(&bytes[at + 48]) & 0x8000) != 0) return true;
  return false;
}

}  // namespace

std::optional<RawCad> readBinaryStl(const std::string& file, const ImportSettings& settings) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in ? static_cast<std::streamoff>(in.tellg()) : 0;
  if (size < static_cast<std::streamoff>(kHeader + kTriangle)) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.seekg(0);
  if (!in.read(bytes.data(), size)) return std::nullopt;
  const std::size_t count = valueAt<std::uint32_t>(&bytes[80]);
  // Some programs append bytes. The number of a text file is made of letters, and is too great.
  if (bytes.size() < kHeader + count * kTriangle) return std::nullopt;
  bytes.resize(kHeader + count * kTriangle);
  if (hasColor(bytes)) return std::nullopt;
  RawCad cad;
  cad.unit_m = unitOf(file, CadFormat::Stl, settings);
  Mesh& mesh = cad.parts.emplace_back().mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const char* corner = &bytes[kHeader + i * kTriangle + 12];
    for (int k = 0; k < 3; ++k, corner += 12)
      mesh.vertices.emplace_back(valueAt<float>(corner), valueAt<float>(corner + 4),
                                 valueAt<float>(corner + 8));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  cad.parts.back().rounding = floatRounding(mesh);
  return cad;
}

}  // namespace vps::scenes::import
