// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/model_meshes.h"

#include <gtest/gtest.h>

namespace vps::viewer {
namespace {

TEST(ModelMeshes, ACubesVoxelsAreItsGrid) {
  // A cube of 4 mm with voxels of 1 mm has 4 x 4 faces on each of six sides, with two triangles each.
  const VoxMap map = buildVoxMap(makeBox({4e-3, 4e-3, 4e-3}), {.voxel_m = 1e-3});
  double cube_m = 0;
  const TintedMesh voxels = voxelMesh(map, &cube_m);
  const Mesh& mesh = voxels.mesh;
  EXPECT_EQ(cube_m, 1e-3);
  EXPECT_EQ(mesh.triangles.size(), 6u * 16 * 2);
  EXPECT_LT((bounds(mesh).size() - Vec3::Constant(4e-3)).norm(), 1e-12);
  EXPECT_EQ(voxels.tints.size(), mesh.vertices.size());
  // Faces point outwards: a step from a face's middle along its normal leads away from the cube's middle.
  for (const auto& t : mesh.triangles) {
    const Vec3 n =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_GT(n.dot(mesh.vertices[t[0]]), 0);
  }
}

TEST(ModelMeshes, TooManyVoxelsAreDrawnAsLargerCubes) {
  const VoxMap map = buildVoxMap(makeBox({0.1, 0.1, 0.1}), {.voxel_m = 0.2e-3});
  double cube_m = 0;
  const TintedMesh voxels = voxelMesh(map, &cube_m);
  const Mesh& mesh = voxels.mesh;
  EXPECT_GT(cube_m, 0.9e-3);  // 60,000 faces on 0.06 m2
  EXPECT_LE(mesh.triangles.size(), kModelTriangles);
  EXPECT_GT(mesh.triangles.size(), kModelTriangles / 10);
}

TEST(ModelMeshes, EachPointIsADiamondAcrossItsNormal) {
  const PointShell shell = buildPointShell(makeBox({4e-3, 4e-3, 4e-3}), {.spacing_m = 1e-3});
  const Mesh mesh = pointMesh(shell, 0.2e-3);
  ASSERT_EQ(mesh.triangles.size(), 2 * shell.size());
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const std::uint32_t point = shell.order[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 off = mesh.vertices[4 * i + k] - shell.points[point];
      EXPECT_NEAR(off.norm(), 0.1e-3, 1e-15);
      EXPECT_NEAR(off.dot(shell.inward[point]), 0, 1e-15);
    }
  }
}

TEST(ModelMeshes, OfNothingIsNothing) {
  EXPECT_TRUE(voxelMesh(VoxMap()).mesh.triangles.empty());
  EXPECT_TRUE(pointMesh(PointShell()).triangles.empty());
}

}  // namespace
}  // namespace vps::viewer
