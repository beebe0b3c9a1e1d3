// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/coarse_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

constexpr double kRadius_m = 0.1;

/// A closed ball whose corners lie on the sphere.
Mesh ball(std::uint32_t rows) {
  Mesh mesh;
  const std::uint32_t columns = 2 * rows;
  mesh.vertices = {{0, 0, kRadius_m}};
  for (std::uint32_t i = 1; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rows, around = 2 * std::numbers::pi * j / columns;
      mesh.vertices.emplace_back(kRadius_m * std::sin(polar) * std::cos(around),
                                 kRadius_m * std::sin(polar) * std::sin(around), kRadius_m * std::cos(polar));
    }
  mesh.vertices.emplace_back(0, 0, -kRadius_m);
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * columns + j % columns; };
  const auto south = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t j = 0; j < columns; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({south, at(rows - 1, j + 1), at(rows - 1, j)});
    for (std::uint32_t i = 1; i + 1 < rows; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

TEST(ShadingMesh, KnowsWhetherItIsClosedAndPointsOutwards) {
  Mesh mesh = ball(12);
  EXPECT_TRUE(buildShadingMesh(mesh).is_closed);
  Mesh inside_out = mesh;
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(buildShadingMesh(inside_out).is_closed);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_FALSE(buildShadingMesh(mesh).is_closed) << "one triangle faces the other way";
  mesh = ball(12);
  mesh.triangles.pop_back();
  EXPECT_FALSE(buildShadingMesh(mesh).is_closed) << "a hole";
}

TEST(CoarseMesh, ASmoothedBallHasFewerTrianglesAndStaysWithinAQuarterOfACell) {
  const ShadingMesh mesh = buildShadingMesh(ball(120));
  const double cell_m = 0.08 * kRadius_m;
  const std::vector<std::uint32_t> fewer = CoarseMesh(mesh).smoothedIndices(cell_m);
  EXPECT_LT(fewer.size(), mesh.indices.size() / 3);
  EXPECT_GT(fewer.size(), mesh.indices.size() / 100);
  double deepest_m = 0, volume_m3 = 0;
  for (std::size_t i = 0; i < fewer.size(); i += 3) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = Eigen::Map<const Eigen::Vector3f>(mesh.vertices[fewer[i + k]].p.data()).cast<double>();
    deepest_m = std::max(deepest_m, kRadius_m - Vec3((p[0] + p[1] + p[2]) / 3).norm());
    volume_m3 += p[0].dot(p[1].cross(p[2])) / 6;
  }
  EXPECT_LT(deepest_m, 0.25 * cell_m);
  // No gap opens: the volume is that of a closed surface that lies at most a quarter of a cell deeper.
  const double ball_m3 = 4.0 / 3 * std::numbers::pi * std::pow(kRadius_m, 3);
  EXPECT_GT(volume_m3, ball_m3 * std::pow(1 - 0.25 * cell_m / kRadius_m, 3));
  EXPECT_LT(volume_m3, ball_m3);
}

TEST(CoarseMesh, ColorsStayApart) {
  const Mesh mesh = ball(120);
  // The colours alternate in stripes of a tenth of the radius.
  scenes::FaceColors colors{{{1, 0, 0}, {0, 0, 1}}, {}};
  for (const auto& t : mesh.triangles) {
    const double z = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).z() / 3;
    colors.of_triangle.push_back(static_cast<std::uint32_t>(std::lround(10 * z / kRadius_m + 20)) % 2);
  }
  const ShadingMesh colored = buildShadingMesh(mesh, kCreaseAngle_rad, &colors);
  ASSERT_EQ(colored.colors.size(), colored.vertices.size());
  CoarseMesh coarse(colored);
  for (const auto& indices :
       {colored.indices, coarse.smoothedIndices(0.2 * kRadius_m), coarse.indices(3000)}) {
    EXPECT_GT(indices.size(), 300U);
    for (std::size_t i = 0; i < indices.size(); i += 3)
      for (std::size_t k = 1; k < 3; ++k)
        ASSERT_EQ(colored.colors[indices[i]], colored.colors[indices[i + k]]) << i;
  }
}

TEST(CoarseMesh, CornersOfABoxStay) {
  const ShadingMesh mesh = buildShadingMesh(makeBox({0.1, 0.1, 0.1}));
  EXPECT_EQ(CoarseMesh(mesh).smoothedIndices(1.0), mesh.indices);
}

}  // namespace
}  // namespace vps::viewer
