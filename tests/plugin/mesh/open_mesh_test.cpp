// SPDX-License-Identifier: BSD-3-Clause
// Which open meshes are treated as sheets, and the models of sheets.
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "support/faulty_meshes.h"
#include "vps/part_model.h"

namespace vps {
namespace {

constexpr double kSpacing_m = 1e-3;

std::shared_ptr<const PartModel> modelOf(const Mesh& mesh, OpenMesh open = OpenMesh::Sheet) {
  return buildPartModel("part", mesh, {.voxel_m = 0.5e-3}, {.spacing_m = kSpacing_m}, {}, open);
}

/// A plate of 20 x 20 x 6 mm whose upper face has a square hole, without walls.
Mesh plateWithHole(double hole_m) {
  const double a = 0.01, b = hole_m / 2, z = 0.003;
  Mesh mesh = makeBox({2 * a, 2 * a, 2 * z});
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.vertices[t[0]].z() + mesh.vertices[t[1]].z() + mesh.vertices[t[2]].z() > 2 * z;
  });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double half : {a, b})
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      mesh.vertices.emplace_back(x * half, y * half, z);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    mesh.triangles.push_back({first + i, first + j, first + 4 + j});
    mesh.triangles.push_back({first + i, first + 4 + j, first + 4 + i});
  }
  return welded(mesh);
}

/// A strip of 8 x 40 facets that turns over like a Moebius strip.
Mesh moebius() {
  Mesh mesh;
  constexpr std::uint32_t kAround = 40, kAcross = 4;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    const double around_rad = 2 * std::numbers::pi * i / kAround, across_m = 2e-3 * (double(j) - 2);
    const double r_m = 20e-3 + across_m * std::cos(around_rad / 2);
    return Vec3(r_m * std::cos(around_rad), r_m * std::sin(around_rad), across_m * std::sin(around_rad / 2));
  };
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Vec3& p : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)})
        mesh.vertices.push_back(p);
      mesh.triangles.push_back({v, v + 1, v + 2});
      mesh.triangles.push_back({v, v + 2, v + 3});
    }
  return welded(mesh, 1e-9);
}

TEST(OpenMesh, AHoleWiderThanThePointsSpacingMakesASheet) {
  for (const double hole_m : {0.9 * kSpacing_m, 1.1 * kSpacing_m, 5e-3}) {
    const auto model = modelOf(plateWithHole(hole_m));
    EXPECT_EQ(model->solid->isSheet(), hole_m > kSpacing_m) << hole_m;
    EXPECT_EQ(model->map == nullptr, hole_m > kSpacing_m) << hole_m;
  }
  const auto declared = modelOf(plateWithHole(5e-3), OpenMesh::Solid);
  EXPECT_FALSE(declared->solid->isSheet());
  EXPECT_LT(declared->map->distance({0, 0, 0}), 0);
}

TEST(OpenMesh, FaultsOfASolidMakeNoSheet) {
  // Solids: meshes with cracks, T-junctions, turned and repeated facets, walls, shells that touch, and narrow
  // or single missing facets. A mesh with a whole row of missing facets is no solid.
  for (const test::FaultyMesh& faulty : test::faultyMeshes())
    EXPECT_FALSE(modelOf(faulty.mesh)->solid->isSheet()) << faulty.fault;
  Mesh box = makeBox(Vec3::Constant(0.02));
  box.triangles.pop_back();
  EXPECT_FALSE(modelOf(box)->solid->isSheet()) << "one facet of twelve";
}

TEST(OpenMesh, ASheetHasPointsOnBothSidesAndOnItsBorder) {
  Mesh flat;
  flat.vertices = {{0, 0, 0}, {0.02, 0, 0}, {0.02, 0.01, 0}, {0, 0.01, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  Mesh both = flat;  // exported for both sides
  for (const auto& t : flat.triangles) both.triangles.push_back({t[0], t[2], t[1]});
  for (const Mesh& mesh : {flat, both}) {
    const auto model = modelOf(mesh);
    ASSERT_TRUE(model->solid->isSheet());
    EXPECT_EQ(model->solid->mesh().triangles.size(), 2u);
    EXPECT_EQ(model->mesh->triangles.size(), mesh.triangles.size());
    std::size_t sides[2] = {0, 0}, border = 0;
    for (std::size_t i = 0; i < model->shell->size(); ++i) {
      const Vec3 &p = model->shell->points[i], &n = model->shell->inward[i];
      EXPECT_NEAR(n.norm(), 1, 1e-12);
      if (std::abs(n.z()) > 0.999)
        ++sides[n.z() > 0];
      else {
        ++border;  // the normal leads from the border into the sheet
        EXPECT_GT(n.dot(Vec3(0.01, 0.005, 0) - p), 0);
      }
    }
    EXPECT_EQ(sides[0], sides[1]);
    EXPECT_GT(sides[0], 200u);
    EXPECT_GE(border, 4u + 2 * (39 + 19));
  }
}

TEST(OpenMesh, ASheetThatTurnsOverHasNormalsEverywhere) {
  const auto model = modelOf(moebius());
  ASSERT_TRUE(model->solid->isSheet());
  const Mesh& mesh = model->solid->mesh();
  EXPECT_EQ(checkMesh(mesh).flipped_edges, 0u) << "cut where its sides meet";
  EXPECT_EQ(mesh.triangles.size(), 320u);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int feature = 0; feature < 7; ++feature)
      EXPECT_NEAR(model->solid->featureNormal(t, feature).norm(), 1, 1e-12);
  for (const Vec3& n : model->shell->inward) EXPECT_NEAR(n.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace vps
