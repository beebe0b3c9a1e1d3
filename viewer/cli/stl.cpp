// SPDX-License-Identifier: BSD-3-Clause
#include "stl.h"

#include <bit>
#include <cstdint>

namespace vps::viewer::inline v0 {

std::string stlBytes(const Mesh& mesh) {
  static_assert(std::endian::native == std::endian::little, "STL is little endian");
  std::string out = "metres";
  out.resize(80, ' ');
  const auto put = [&out](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int axis = 0; axis < 3; ++axis) put(0.0f);  // the normal: readers compute it from the winding
    for (const std::uint32_t vertex : triangle)
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(mesh.vertices[vertex][axis]));
    put(std::uint16_t{0});
  }
  return out;
}

}  // namespace vps::viewer::inline v0
