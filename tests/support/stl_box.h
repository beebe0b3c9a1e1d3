// SPDX-License-Identifier: BSD-3-Clause
// Meshes as the bytes of a binary STL file, for tests that read files.
#pragma once

#include <cstdint>
#include <string>

#include "vps/mesh.h"

namespace vps {

/// Binary STL of a mesh, with its coordinates unchanged.
inline std::string stlOf(const Mesh& mesh) {
  std::string out(80, ' ');
  const auto put = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const std::uint32_t vertex : triangle)
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(mesh.vertices[vertex][axis]));
    put(std::uint16_t{0});
  }
  return out;
}

inline std::string stlBox(const Vec3& size) {
  return stlOf(makeBox(size));
}

}  // namespace vps
