// SPDX-License-Identifier: BSD-3-Clause
// The components of the voxeliser, each compared with an exhaustive search; voxmap_test.cpp tests the whole.
#include "voxelise/splat.h"

#include <gtest/gtest.h>

#include <cfloat>

#include "support/analytic.h"
#include "voxmap/field_bounds.h"
#include "vps/mesh_distance.h"

namespace vps::test {
namespace {

struct Plane {
  Vec3 n;
  double d;
  [[nodiscard]] double at(const Vec3& p) const { return n.dot(p) + d; }
};

/// A random region of up to eight planes, some of them vertical or horizontal, and its box.
SplatRegion randomRegion(RandomPoints& random, std::vector<Plane>& planes) {
  SplatRegion region;
  for (int axis = 0; axis < 3; ++axis) {
    region.low[axis] = static_cast<int>(8 + 8 * random.unit());
    region.high[axis] = std::min(kTile, region.low[axis] + static_cast<int>(10 + 10 * random.unit()));
  }
  planes.clear();
  const int count = 1 + static_cast<int>(3.9 + 3.9 * random.unit());
  for (int k = 0; k < count; ++k) {
    Vec3 n = random.inBox(Vec3::Ones());
    if (k % 3 == 1) n.z() = 0;
    if (k % 3 == 2) n.x() = n.y() = 0;
    n.normalize();
    planes.push_back({n, -n.dot(Vec3::Constant(14) + random.inBox(Vec3::Constant(6)))});
    region.add(n.x(), n.y(), n.z(), planes.back().d, 1);
  }
  return region;
}

TEST(SplatRows, ContainEveryNodeOfTheRegionAndNoneFarBeyondIt) {
  RandomPoints random(1);
  std::vector<Plane> planes;
  std::array<SplatRow, kMaxRows + 8> rows;
  int held = 0;
  for (int n = 0; n < 2000; ++n) {
    const SplatRegion region = randomRegion(random, planes);
    std::array<bool, std::size_t{kTileNodes}* kTileNodes* kTileNodes> is_held = {};
    const int count = findRows(region, rows.data());
    for (int i = 0; i < count; ++i)
      for (int z = rows[i].low; z <= rows[i].high; ++z) is_held[tileIndex(rows[i].x, rows[i].y, z)] = true;
    for (int x = 0; x < kTileNodes; ++x)
      for (int y = 0; y < kTileNodes; ++y)
        for (int z = 0; z < kTileNodes; ++z) {
          const Index3 node(x, y, z);
          bool is_in_box = true;
          for (int axis = 0; axis < 3; ++axis)
            is_in_box = is_in_box && node[axis] >= region.low[axis] && node[axis] <= region.high[axis];
          double least = 1e300;
          for (const Plane& plane : planes) least = std::min(least, plane.at(node.cast<double>()));
          const bool has = is_held[tileIndex(x, y, z)];
          if (is_in_box && least >= 0) {
            ASSERT_TRUE(has) << node.transpose();
          }
          // Tolerance beyond the region: the margin, 2e-3 of a node along z, and the tilt of vertical planes
          // over a tile.
          if (has) {
            ASSERT_TRUE(is_in_box && least > -(SplatRegion::kRoundingMargin + 2e-3 + 1e-6 * kTile)) << least;
          }
          held += has;
        }
  }
  EXPECT_GT(held, 10000);
}

TEST(SplatRows, AreTheSameWithoutVectorInstructions) {
  RandomPoints random(2);
  std::vector<Plane> planes;
  std::array<SplatRow, kMaxRows + 8> one, other;
  for (int n = 0; n < 5000; ++n) {
    const SplatRegion region = randomRegion(random, planes);
    const int count = findRows(region, one.data());
    ASSERT_EQ(findRowsBaseline(region, other.data()), count);
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(one[i].x, other[i].x);
      ASSERT_EQ(one[i].y, other[i].y);
      ASSERT_EQ(one[i].low, other[i].low);
      ASSERT_EQ(one[i].high, other[i].high);
    }
  }
}

/// Splats a mesh in voxels into the one tile at the origin and compares each node with exhaustive search: the
/// distance always, and the sign if the mesh determines one.
void expectTileExact(const Mesh& mesh, bool has_sign, const Mesh& truth_mesh) {
  constexpr double kBand = 4;
  const SurfaceFeatures features(mesh, 1, Vec3::Zero());
  Splatter splatter(features, kBand);
  auto tile = std::make_unique<Tile>();
  tile->fill(FLT_MAX);
  for (std::uint32_t i = 0; i < splatter.count(); ++i)
    if (!splatter.reach(i).isEmpty()) splatter.splat(i, Vec3::Zero(), tile->data());
  const MeshDistance truth(truth_mesh);
  for (int x = 0; x < kTileNodes; ++x)
    for (int y = 0; y < kTileNodes; ++y)
      for (int z = 0; z < kTileNodes; ++z) {
        const double d = truth.signedDistance(Vec3(x, y, z));
        const float got = (*tile)[tileIndex(x, y, z)];
        if (std::abs(d) >= kBand) {
          ASSERT_EQ(got, FLT_MAX);
          continue;
        }
        // Regions overlap by 1e-7, and a float of up to 4 is rounded by 1.2e-7.
        ASSERT_NEAR(std::abs(got), std::abs(d), 2.2e-7 + 1e-12) << x << ' ' << y << ' ' << z;
        if (has_sign && std::abs(d) > 1e-6) {
          ASSERT_EQ(got < 0, d < 0) << x << ' ' << y << ' ' << z;
        }
      }
}

Mesh placed(const Mesh& mesh, unsigned seed) {
  Pose X = RandomPoints(seed).pose(1);
  X.p += Vec3::Constant(16);
  return transformed(mesh, X);
}

TEST(Splat, ClosedMeshesAreExactAndRightlySigned) {
  for (unsigned seed = 0; seed < 4; ++seed)
    for (const Mesh& mesh :
         {makeBox({9, 7, 0.3}), makeSphere(8, 3), makeTube(9, 5, 12, 300), makeSphere(0.3, 2)})
      expectTileExact(placed(mesh, seed), true, placed(mesh, seed));
}

TEST(Splat, OpenAndInconsistentMeshesHaveTheirDistance) {
  Mesh open = placed(makeSphere(8, 2), 5);
  open.triangles.resize(open.triangles.size() / 3);
  expectTileExact(open, false, open);
  Mesh flipped = placed(makeSphere(8, 2), 6);
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 3)
    std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
  expectTileExact(flipped, false, flipped);
  // Three leaves at one edge.
  Mesh fan;
  fan.vertices = {{10, 12, 14}, {20, 21, 16}, {16, 8, 9}, {24, 12, 20}, {9, 18, 22}};
  fan.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  expectTileExact(fan, false, fan);
}

/// A wedge whose ridge is split on the upper side only, and a triangle without area that closes the gap.
TEST(Splat, ACollinearTriangleDoesNotSpoilTheSignAtASharpRidge) {
  for (const double tip : {0.5, 2.0, 9.0}) {
    Mesh whole;
    whole.vertices = {{0, 0, 0}, {0, 14, 0}, {14, 0, -tip}, {14, 14, -tip}, {14, 0, tip}, {14, 14, tip}};
    whole.triangles = {{0, 4, 5}, {0, 5, 1}, {0, 1, 3}, {0, 3, 2},
                       {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}};
    Mesh split = whole;
    split.vertices.push_back({0, 5.3, 0});
    split.triangles.erase(split.triangles.begin(), split.triangles.begin() + 2);
    for (const auto& t : {std::array<std::uint32_t, 3>{0, 4, 6}, {6, 4, 5}, {6, 5, 1}, {0, 6, 1}})
      split.triangles.push_back(t);
    ASSERT_TRUE(checkMesh(split).isClosed());
    for (unsigned seed = 0; seed < 3; ++seed) expectTileExact(placed(split, seed), true, placed(whole, seed));
  }
}

TEST(CenterBounds, AreTheDistanceToTheMarkedCubes) {
  RandomPoints random(3);
  const Index3 size(5, 4, 6);
  const auto count = static_cast<std::size_t>(size.prod());
  for (const double share : {0.02, 0.3}) {
    std::vector<std::int32_t> brick(count, -1);
    std::vector<SurfaceBits> bits;
    std::vector<Vec3> centers;  // of the cubes: 2 x 2 x 1 nodes
    for (std::size_t cell = 0; cell < count; ++cell) {
      const Index3 at(static_cast<int>(cell) / 24, static_cast<int>(cell) / 6 % 4,
                      static_cast<int>(cell) % 6);
      if (cell != 50 && 0.5 + 0.5 * random.unit() > share) continue;
      brick[cell] = static_cast<std::int32_t>(bits.size());
      SurfaceBits& marked = bits.emplace_back();
      const int row = static_cast<int>(8 + 7.9 * random.unit()),
                z = static_cast<int>(4 + 3.9 * random.unit());
      marked.rows[static_cast<std::size_t>(row)] = static_cast<std::uint8_t>(1 << z);
      centers.push_back(8 * at.cast<double>() + Vec3(row / 4 * 2 + 0.5, row % 4 * 2 + 0.5, z));
    }
    const std::vector<float> bound = boundCellCenters(size, brick, bits);
    for (std::size_t cell = 0; cell < count; ++cell) {
      const Index3 at(static_cast<int>(cell) / 24, static_cast<int>(cell) / 6 % 4,
                      static_cast<int>(cell) % 6);
      double least = 1e300;
      for (const Vec3& c : centers)
        least = std::min(least, boxDistance(8 * at.cast<double>() + Vec3::Constant(4) - c, {1, 1, 0.5}));
      least = std::max(least, 0.0);
      EXPECT_LE(bound[cell], least);
      EXPECT_GE(bound[cell], least * (1 - 3e-6));  // the bound is lowered by 1e-6; the rest is float rounding
    }
  }
}

}  // namespace
}  // namespace vps::test
