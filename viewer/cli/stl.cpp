// SPDX-License-Identifier: BSD-3-Clause
#include "stl.h"

#include <array>
#include <bit>
#include <charconv>
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

std::string meshExtension(const Mesh& mesh) {
  constexpr double kMostRounding_m = 0.1e-6, kFloat = 0x1p-24;
  constexpr double kFar = 4;  // sizes: a reader that takes off the middle of the vertices wins two bits
  const Box box = bounds(mesh);
  const double farthest_m = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
  return kFloat * farthest_m > kMostRounding_m && farthest_m > kFar * box.size().norm() ? ".obj" : ".stl";
}

std::string meshBytes(const Mesh& mesh) {
  if (meshExtension(mesh) == ".stl") return stlBytes(mesh);
  std::string out = "# metres\n";
  const auto put = [&out](auto value) {
    std::array<char, 32> text;
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    out.append(1, ' ').append(text.data(), end);
  };
  for (const Vec3& p : mesh.vertices) {
    out += 'v';
    for (int axis = 0; axis < 3; ++axis) put(p[axis]);
    out += '\n';
  }
  for (const auto& triangle : mesh.triangles) {
    out += 'f';
    for (const std::uint32_t vertex : triangle) put(vertex + 1);
    out += '\n';
  }
  return out;
}

}  // namespace vps::viewer::inline v0
