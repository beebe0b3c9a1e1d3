// SPDX-License-Identifier: BSD-3-Clause
#include "input/mesh_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <utility>

namespace vps::viewer {

std::string stlBytes(const Mesh& mesh) {
  static_assert(std::endian::native == std::endian::little, "STL is little endian");
  std::string out = "metres";
  out.resize(80, ' ');
  const auto put = [&out](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int axis = 0; axis < 3; ++axis) put(0.0f);  // zero normal: readers use the winding
    for (const std::uint32_t vertex : triangle)
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(mesh.vertices[vertex][axis]));
    put(std::uint16_t{0});
  }
  return out;
}

std::string meshExtension(const Mesh& mesh, const scenes::FaceColors& colors) {
  constexpr double kMostRounding_m = 0.1e-6, kFloat = 0x1p-24;
  constexpr double kFar =
      4;  // distance from the origin in sizes of the mesh; a reader that subtracts the centre gains two bits
  const Box box = bounds(mesh);
  const double farthest_m = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
  const bool is_far = kFloat * farthest_m > kMostRounding_m && farthest_m > kFar * box.size().norm();
  return is_far || !colors.isNone() ? ".obj" : ".stl";
}

std::string meshBytes(const Mesh& mesh, const scenes::FaceColors& colors) {
  if (meshExtension(mesh, colors) == ".stl") return stlBytes(mesh);
  std::string out = "# metres\n", faces;
  const auto put = [](std::string& to, auto value) {
    std::array<char, 32> text;
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    to.append(1, ' ').append(text.data(), end);
  };
  const auto putVertex = [&](std::uint32_t vertex) {
    out += 'v';
    for (int axis = 0; axis < 3; ++axis) put(out, mesh.vertices[vertex][axis]);
  };
  // A vertex at which several colours meet is written once for each colour.
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> number_of;  // by vertex and colour
  if (colors.isNone())
    for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
      putVertex(vertex);
      out += '\n';
    }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    faces += 'f';
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (colors.isNone()) {
        put(faces, vertex + 1);
        continue;
      }
      const auto [it, is_new] = number_of.try_emplace({vertex, colors.of_triangle[i]},
                                                      static_cast<std::uint32_t>(number_of.size() + 1));
      if (is_new) {
        putVertex(vertex);
        for (const float channel : scenes::srgbFromLinear(colors.at(i))) put(out, channel);
        out += '\n';
      }
      put(faces, it->second);
    }
    faces += '\n';
  }
  return out + faces;
}

std::string partFileName(const std::string& name, const std::string& extension,
                         std::set<std::string>& taken) {
  std::string stem;
  for (const unsigned char c : name)
    stem += std::isalnum(c) || c == '-' || c == '_' ? static_cast<char>(c) : '_';
  constexpr std::size_t kLongest = 100;  // bytes; file systems allow at least 255 bytes
  if (stem.size() > kLongest) stem.resize(kLongest);
  if (stem.empty()) stem = "part";
  // "A.stl" and "a.stl" are one file on some systems.
  const auto isNew = [&](std::string file) {
    std::ranges::transform(file, file.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return taken.insert(std::move(file)).second;
  };
  std::string file = stem + extension;
  for (int i = 2; !isNew(file); ++i) file = stem + "_" + std::to_string(i) + extension;
  return file;
}

}  // namespace vps::viewer
