// SPDX-License-Identifier: BSD-3-Clause
#include "products.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "support/lathe.h"

namespace vps::bench {
namespace {

namespace fs = std::filesystem;
using Profile = std::vector<std::array<double, 2>>;

/// The profile with additional points between its points, so that the triangles are no slivers.
Profile divided(const Profile& profile, int pieces) {
  Profile out;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    const int count = a[0] == 0 && b[0] == 0 ? 1 : pieces;
    for (int k = 0; k < count; ++k)
      out.push_back({a[0] + (b[0] - a[0]) * k / count, a[1] + (b[1] - a[1]) * k / count});
  }
  return out;
}

/// A turned part with about this number of triangles.
Mesh turned(const Profile& profile, std::size_t triangles) {
  // A profile of e edges with p pieces each, swept in s segments, has about 2 e p s triangles; with s = 8 p
  // the pieces are about as long as wide.
  const double edges = static_cast<double>(profile.size());
  const int pieces =
      std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / (16 * edges)))));
  const int segments = std::max(8, static_cast<int>(std::lround(static_cast<double>(triangles) /
                                                                (2 * edges * static_cast<double>(pieces)))));
  return test::lathe(divided(profile, pieces), segments);
}

void writeStl(const fs::path& file, const Mesh& mesh) {
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
  std::ofstream(file, std::ios::binary) << out;
}

constexpr double kRadius_m = 4e-3, kClearance_m = 0.1e-3, kPitch_m = 20e-3;

/// A bush with a floor, on which the pin stands.
Mesh bush(std::size_t triangles) {
  const double bore_m = kRadius_m + kClearance_m;
  return turned(
      {{0, 0}, {8e-3, 0}, {8e-3, 15e-3}, {bore_m + 1e-3, 15e-3}, {bore_m, 14e-3}, {bore_m, 3e-3}, {0, 3e-3}},
      triangles);
}

Mesh pin(std::size_t triangles) {
  return turned({{0, 0}, {kRadius_m - 1e-3, 0}, {kRadius_m, 1e-3}, {kRadius_m, 25e-3}, {0, 25e-3}},
                triangles);
}

/// A stepped shaft, whose height depends on its number.
Mesh bystander(std::size_t number, std::size_t triangles) {
  const double height_m = 20e-3 + 1e-6 * static_cast<double>(number % 10000);
  return turned({{0, 0}, {8e-3, 0}, {8e-3, 6e-3}, {5e-3, 8e-3}, {5e-3, height_m}, {0, height_m}}, triangles);
}

}  // namespace

fs::path writeManyParts(const fs::path& folder, const ManyParts& size) {
  fs::create_directories(folder);
  writeStl(folder / "bush.stl", bush(size.triangles));
  writeStl(folder / "pin.stl", pin(size.triangles));
  const std::size_t around = size.parts - 2,
                    shapes = size.shapes > 0 ? std::min(size.shapes, around) : around;
  for (std::size_t i = 0; i < shapes; ++i)
    writeStl(folder / ("part_" + std::to_string(i) + ".stl"), bystander(i, size.triangles));
  const fs::path file = folder / "scene.toml";
  std::ofstream out(file);
  out << "unit = \"m\"\n\n[[part]]\nfile = \"bush.stl\"\nfixed = true\n\n[[part]]\nfile = \"pin.stl\"\n"
         "pose = {position = [0, 0, 0.003]}\n\n";
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(size.parts))));
  for (std::size_t i = 0; i < around; ++i) {
    const std::size_t at = i + 1;
    out << "[[part]]\nfile = \"part_" << i % shapes << ".stl\"\nname = \"part " << i
        << "\"\nfixed = true\npose = {position = [" << kPitch_m * static_cast<double>(at % columns) << ", "
        << kPitch_m * static_cast<double>(at / columns) << ", 0]}\n\n";
  }
  out << "[[step]]\npart = \"pin\"\napproach = [0, 0, 0.02]\n";
  return file;
}

}  // namespace vps::bench
