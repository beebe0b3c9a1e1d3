// SPDX-License-Identifier: BSD-3-Clause
// Invalid and extreme meshes: each gives a clear LoadError or the right answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "support/analytic.h"
#include "voxmap/voxmap_layout.h"
#include "vps/errors.h"
#include "vps/mesh_distance.h"
#include "vps/voxmap.h"

namespace vps::test {
namespace {

std::string refusal(const Mesh& mesh, const VoxMapSettings& settings) {
  try {
    buildVoxMap(mesh, settings, "hub");
  } catch (const LoadError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BadInput, InvalidMeshesAreRefusedWithAReason) {
  const VoxMapSettings settings = {0.5e-3, 4};
  EXPECT_EQ(refusal(Mesh{}, settings), "part 'hub': the mesh has no triangles; export it as a triangle mesh");
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    Mesh mesh = makeBox({0.01, 0.01, 0.01});
    mesh.vertices[3].z() = bad;
    EXPECT_EQ(refusal(mesh, settings), std::string("part 'hub': vertex 3 is ") +
                                           (std::isnan(bad) ? "not a number" : "infinite") +
                                           "; export it again");
  }
  Mesh flat = makeBox({0.01, 0.01, 0.01});
  for (Vec3& p : flat.vertices) p = Vec3(p.x(), 0, 0);
  EXPECT_NE(refusal(flat, settings).find("zero area"), std::string::npos);
  EXPECT_NE(refusal(makeBox({1e200, 1e200, 1e200}), settings).find("too large"), std::string::npos);
}

TEST(BadInput, TooFineAVoxelIsRefusedBeforeMemoryIsAllocated) {
  for (const double size_m : {1e-6, 0.01, 100.0}) {
    const std::string text = refusal(makeBox(Vec3::Constant(size_m)), {1e-6 * size_m, 4});
    EXPECT_NE(text.find("would fit"), std::string::npos) << text;
  }
}

/// The message of the error.
template <typename Do>
std::string refusalOf(Do what) {
  try {
    what();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BadInput, ResamplingTooFinelyIsRefusedBeforeMemoryIsAllocated) {
  const VoxMap box = buildVoxMap(makeBox(Vec3::Constant(0.1)), {1e-3, 4});
  // Bricks of 8 um over 50 mm and over the band on each side: floor(6250.4) + 2 in each direction.
  const std::string text = refusalOf([&] { static_cast<void>(resampledVoxMap({&box, {}}, {1e-6, 3})); });
  EXPECT_NE(text.find("12504 x 12504 x 12504"), std::string::npos) << text;
  double times = 0;
  ASSERT_EQ(std::sscanf(text.c_str() + text.find("voxels "), "voxels %lf times", &times), 1) << text;
  EXPECT_GT(times, 10);
  EXPECT_LT(times, 40);
}

TEST(BadInput, ResamplingOntoAnInvalidGridIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const VoxMap box = buildVoxMap(makeBox(Vec3::Constant(0.01)), {0.5e-3, 4});
  const auto refusal = [&](const VoxMapSettings& settings) {
    return refusalOf([&] { static_cast<void>(resampledVoxMap({&box, {}}, settings)); });
  };
  for (const double voxel_m : {0.0, -1e-3, kNan, std::numeric_limits<double>::infinity(), 1e-35})
    EXPECT_NE(refusal({voxel_m, 3}).find("voxel size must"), std::string::npos) << refusal({voxel_m, 3});
  for (const double band_voxels : {0.0, 2.9, 65.0, kNan})
    EXPECT_NE(refusal({0.1e-3, band_voxels}).find("band must be"), std::string::npos) << band_voxels;
}

TEST(BadInput, MountingOnAnEmptyMapOrAnEmptyMapIsRefused) {
  const VoxMap box = buildVoxMap(makeBox(Vec3::Constant(0.01)), {0.5e-3, 4});
  const VoxMap none;
  const auto refusal = [](const VoxMap& cooked, const VoxMap& part) {
    return refusalOf([&] { static_cast<void>(mountVoxMap(cooked, PlacedMap{&part, {}})); });
  };
  EXPECT_NE(refusal(none, box).find("no voxmap to mount on"), std::string::npos) << refusal(none, box);
  EXPECT_NE(refusal(none, none).find("no voxmap to mount on"), std::string::npos) << refusal(none, none);
  EXPECT_NE(refusal(box, none).find("distances up to 0"), std::string::npos) << refusal(box, none);
}

TEST(BadInput, APoseThatIsNotFiniteIsRefused) {
  const Mesh mesh = makeBox(Vec3::Constant(0.01));
  const VoxMap box = buildVoxMap(mesh, {0.5e-3, 4});
  const auto expect = [&](const Pose& X_MP, const char* text) {
    for (const std::string& said : {refusalOf([&] {
                                      static_cast<void>(mountVoxMap(box, PlacedMap{&box, X_MP}));
                                    }),
                                    refusalOf([&] {
                                      static_cast<void>(mountVoxMap(box, PlacedMesh{&mesh, X_MP}));
                                    }),
                                    refusalOf([&] {
                                      static_cast<void>(cookVoxMap({{&mesh, X_MP}}, {0.5e-3, 4}));
                                    }),
                                    refusalOf([&] {
                                      static_cast<void>(resampledVoxMap({&box, X_MP}, {0.5e-3, 4}));
                                    })})
      EXPECT_NE(said.find(text), std::string::npos) << said;
  };
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect(Pose::translation({0, bad, 0}), "is not finite");
    Pose X_MP;
    X_MP.R(1, 2) = bad;
    expect(X_MP, "is not finite");
  }
  expect(Pose::translation({1e9, 0, 0}), "too far");
}

TEST(BadInput, PartsTooFarApartForOneDirectoryAreRefusedBeforeMemoryIsAllocated) {
  const Mesh mesh = makeBox(Vec3::Constant(0.01));
  const VoxMap box = buildVoxMap(mesh, {0.1e-3, 4});
  const Pose X_MP = Pose::translation({1.2, -1.2, 1.2});  // 2.1 m
  for (const std::string& said : {refusalOf([&] {
                                    static_cast<void>(cookVoxMap({{&mesh, {}}, {&mesh, X_MP}}, {0.1e-3, 4}));
                                  }),
                                  refusalOf([&] {
                                    static_cast<void>(mountVoxMap(box, PlacedMap{&box, X_MP}));
                                  })})
    EXPECT_NE(said.find("for its directory"), std::string::npos) << said;
}

TEST(BadInput, MoreBricksThanHaveNamesAreRefusedBeforeMemoryIsAllocated) {
  VoxLayout layout;
  layout.pool = std::make_shared<VoxPool>(0);
  const std::string said = refusalOf([&] { takeBricks(layout, VoxPool::kMaxBricks + 1); });
  EXPECT_NE(said.find("5835552 bricks"), std::string::npos)
      << said;  // (2^32 - 1) / 736 bricks, less the two constant bricks, plus one
  EXPECT_NE(takeBricks(layout, 1), 0u);
}

TEST(BadInput, AVoxelSizeBeyondTheRangeOfFloatsIsRefused) {  // found by fuzzing: the band became zero
  Mesh mesh = makeSphere(1e-70, 1);
  EXPECT_NE(refusal(mesh, {1e-71, 4}).find("is the unit right"), std::string::npos);
}

/// A rotated tube of any size has signs and distances as exact as at the usual size.
void expectRightAtSize(double size_m) {
  const Mesh unit = transformed(makeTube(1, 0.6, 1.2, 48), RandomPoints(2).pose(1));
  Mesh mesh = unit;
  for (Vec3& p : mesh.vertices) p *= size_m;
  MeshReport report;
  const VoxMap map = buildVoxMap(mesh, {size_m / 20, 4}, "", {}, &report);
  EXPECT_FALSE(report.signed_by_winding);
  const MeshDistance truth(unit);
  RandomPoints random(3);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 at = (bounds(unit).center() + random.inBox(0.7 * bounds(unit).size())) * 20;
    const Vec3 p = at.array().round() / 20;
    const double expected = std::clamp(truth.signedDistance(p), -0.2, 0.2) * size_m;
    // Half a quantum, the rounding of floats at the band, and the rounding of the node's position.
    ASSERT_NEAR(map.distance(size_m * p), expected, 0.51 * map.quantum_m()) << size_m;
  }
}
TEST(BadInput, AMicrometrePartIsExact) {
  expectRightAtSize(1e-6);
}
TEST(BadInput, AHundredMetrePartIsExact) {
  expectRightAtSize(100);
}
TEST(BadInput, APicometrePartIsExact) {
  expectRightAtSize(1e-12);
}

TEST(BadInput, AFaultyPartOfAnySizeHasTheSameSigns) {
  Mesh unit = transformed(makeSphere(1, 3), RandomPoints(4).pose(1));
  unit.triangles.resize(unit.triangles.size() - 40);
  std::string first;
  for (const double size_m : {1.0, 1e-12, 1e-6, 100.0}) {
    Mesh mesh = unit;
    for (Vec3& p : mesh.vertices) p *= size_m;
    const VoxMap map = buildVoxMap(mesh, {size_m / 16, 4});
    std::string signs;
    RandomPoints random(5);
    for (int n = 0; n < 2000; ++n) {
      const Vec3 at = (bounds(unit).center() + random.inBox(0.7 * bounds(unit).size())) * 16;
      signs.push_back(map.distance(size_m * Vec3(at.array().round() / 16)) < 0 ? '-' : '+');
    }
    if (first.empty()) first = signs;
    EXPECT_EQ(signs, first) << size_m;
  }
}

TEST(BadInput, AVoxelLargerThanThePartStillGivesASign) {
  MeshReport report;
  const VoxMap map = buildVoxMap(makeSphere(0.3, 2), {1.0, 3}, "", {}, &report);
  EXPECT_LT(map.distance({0, 0, 0}), 0);
  EXPECT_GT(map.distance({1, 0, 0}), 0);
}

TEST(BadInput, OneTriangleIsASheetWithoutAnInside) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0.1e-3}, {0.01, 0, 0.1e-3}, {0, 0.01, 0.1e-3}};
  mesh.triangles = {{0, 1, 2}};
  MeshReport report;
  const VoxMap map = buildVoxMap(mesh, {0.5e-3, 4}, "", {}, &report);
  EXPECT_EQ(report.sheet_facets, 1u);
  for (int x = -10; x < 30; ++x)
    for (int z = -10; z < 10; ++z) ASSERT_GE(map.distance(0.5e-3 * Vec3(x, 4, z)), 0);
  EXPECT_NEAR(map.distance({2e-3, 2e-3, 1e-3}), 0.9e-3, 0.51 * map.quantum_m());
}

}  // namespace
}  // namespace vps::test
