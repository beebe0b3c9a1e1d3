// SPDX-License-Identifier: BSD-3-Clause
// Union and resampling, compared with the fields from which they are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/analytic.h"
#include "voxmap/voxmap_access.h"
#include "vps/errors.h"
#include "vps/mesh_distance.h"
#include "vps/query.h"
#include "vps/voxmap.h"

namespace vps::test {
namespace {

constexpr double kFineVoxel_m = 0.25e-3;
constexpr VoxMapSettings kFineSettings = {kFineVoxel_m, 3};

/// Rounding error of a node's position, which changes the reading by 1e-15 of the distance between nodes.
constexpr double kRounding_m = 1e-15;

/// Grid nodes at random within a box.
template <typename Visit>
void forRandomNodes(int count, double reach_m, Visit visit) {
  RandomPoints random(31);
  for (int n = 0; n < count; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(reach_m));
    visit(Vec3(kFineVoxel_m * (p / kFineVoxel_m).array().round().matrix()));
  }
}

TEST(CombinedVoxMap, TheUnionIsTheMinimumAtEveryNode) {
  const VoxMap block = buildVoxMap(makeBox({0.012, 0.01, 0.008}), kFineSettings);
  const VoxMap ball =
      buildVoxMap(transformed(makeSphere(0.004, 4), Pose::translation({0.005, 0, 0.002})), kFineSettings);
  const VoxMap both = mergedVoxMap(block, ball);
  forRandomNodes(40000, 0.011, [&](const Vec3& p) {
    ASSERT_NEAR(both.distance(p), std::min(block.distance(p), ball.distance(p)), kRounding_m);
    if (std::abs(both.distance(p)) < both.band_m() - kRounding_m &&
        std::abs(block.distance(p) - ball.distance(p)) > kRounding_m) {
      ASSERT_EQ(both.owner(p), block.distance(p) <= ball.distance(p) ? 0 : 1);
    }
    // Bounds still distinguish far from near in the merged field.
    const double block_m = boxDistance(p, {0.006, 0.005, 0.004});
    const double ball_m = (p - Vec3(0.005, 0, 0.002)).norm() - 0.004;
    const double sagitta_m = 2e-5;  // of a ball of 5120 triangles
    ASSERT_LE(both.lowerBound(p), std::abs(std::min(block_m, ball_m)) + sagitta_m);
  });
}

TEST(ResampledVoxMap, AMapWithANarrowerBandIsRefused) {
  const VoxMap a = buildVoxMap(makeBox({0.004, 0.004, 0.004}), kFineSettings);
  EXPECT_THROW(resampledVoxMap({&a, Pose()}, {kFineVoxel_m, 4}), LoadError);
}

TEST(ResampledVoxMap, EveryNodeIsTheSourceReadThere) {
  const Mesh tube = makeTube(0.006, 0.004, 0.005, 96);
  const MeshDistance truth(tube);
  const VoxMap source = buildVoxMap(tube, {kFineVoxel_m, 4});
  for (const Pose& X_MP :
       {Pose(), Pose::translation({0.1e-3, 0.2e-3, 0.05e-3}), RandomPoints(4).pose(0.003)}) {
    const VoxMap moved = resampledVoxMap({&source, X_MP}, kFineSettings);
    const Pose X_PM = X_MP.inverse();
    forRandomNodes(40000, 0.012, [&](const Vec3& p) {
      const double expected_m = std::clamp(source.distance(X_PM * p), -moved.band_m(), moved.band_m());
      // Half a quantum of the resampled map, and the rounding of positions in the vectorised reading: 1e-4
      // voxel.
      ASSERT_NEAR(moved.distance(p), expected_m, 0.51 * moved.quantum_m() + 1e-4 * kFineVoxel_m);
      // The lower bound holds at every distance; the margin is for the rounding of doubles.
      ASSERT_LE(moved.lowerBound(p), truth.closest(X_PM * p).distance_m + 1e-12) << p.transpose();
    });
  }
}

TEST(ResampledVoxMap, SphereStaysWithinTwiceTheSmoothError) {
  // Error of trilinear interpolation on a sphere: h^2/8 times 2/r, once in the source map and once in the
  // resampled one.
  constexpr double kRadius_m = 0.008;
  const VoxMap source = buildVoxMap(makeSphere(kRadius_m, 6), {kFineVoxel_m, 4});
  const Pose X_MP = RandomPoints(5).pose(0.002);
  const VoxMap moved = resampledVoxMap({&source, X_MP}, kFineSettings);
  const double sagitta_m = 2e-6;  // 81,920 triangles: r (1 - cos(edge / 2r)), edge 0.14 mm
  const double tolerance_m = 2 * kFineVoxel_m * kFineVoxel_m / (4 * (kRadius_m - 3 * kFineVoxel_m)) +
                             sagitta_m + 2 * moved.quantum_m();
  RandomPoints random(6);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 direction = random.inBox(Vec3::Ones()).normalized();
    const double d = 2 * kFineVoxel_m * random.unit();
    ASSERT_NEAR(moved.distance(X_MP * ((kRadius_m + d) * direction)), d, tolerance_m);
  }
}

TEST(ResampledVoxMap, MountingIsTheUnionWithTheResampledPart) {
  const VoxMap plate = buildVoxMap(makeBox({0.02, 0.02, 0.004}), kFineSettings);
  const VoxMap pin = buildVoxMap(makeCylinder(0.003, 0.01, 48), kFineSettings);
  const Pose X_MP = RandomPoints(7).pose(0.003);
  const VoxMap mounted = mountVoxMap(plate, PlacedMap{&pin, X_MP});
  const VoxMap expected = mergedVoxMap(plate, resampledVoxMap({&pin, X_MP}, kFineSettings));
  forRandomNodes(40000, 0.013, [&](const Vec3& p) {
    ASSERT_EQ(mounted.distance(p), expected.distance(p));
    ASSERT_EQ(mounted.owner(p), expected.owner(p));
  });
  EXPECT_EQ(mounted.partCount(), 2u);
  // Mounting the pin does not change the plate's map.
  const VoxMap again = buildVoxMap(makeBox({0.02, 0.02, 0.004}), kFineSettings);
  forRandomNodes(5000, 0.013, [&](const Vec3& p) { ASSERT_EQ(plate.distance(p), again.distance(p)); });
}

TEST(ResampledVoxMap, DiscardedMountingsFreeTheirMemory) {
  const Mesh block = makeBox({0.012, 0.01, 0.008});
  const VoxMap base = cookVoxMap({{&block, Pose()}}, kFineSettings);
  const VoxMap ball = buildVoxMap(makeSphere(0.004, 4), kFineSettings);
  const auto mounted = [&](double x_m) {
    return mountVoxMap(base, PlacedMap{&ball, Pose::translation({x_m, 0, 0.002})});
  };
  const auto readings = [](const VoxMap& map) {
    std::vector<double> d;
    forRandomNodes(2000, 0.011, [&](const Vec3& p) { d.push_back(map.distance(p)); });
    return d;
  };
  const std::size_t bytes = base.memoryBytes();
  const std::vector<double> base_reads = readings(base), first_reads = readings(mounted(0.005));
  VoxMap kept;
  for (int n = 0; n < 40; ++n) {
    const VoxMap tried = mounted(0.003 + 1e-4 * n);
    // A map that is mounted on another outlives it.
    kept = mountVoxMap(tried, PlacedMap{&ball, Pose::translation({0.005, 0, 0.002})});
  }
  const std::vector<double> kept_reads = readings(kept);
  VoxMap other = mounted(0.005);
  EXPECT_EQ(readings(kept), kept_reads);
  kept = VoxMap();
  EXPECT_EQ(readings(other), first_reads);
  EXPECT_EQ(readings(base), base_reads);
  EXPECT_GT(base.memoryBytes(), bytes);  // shares its pool with `other`
  other = VoxMap();
  EXPECT_EQ(base.memoryBytes(), bytes);
}

TEST(ResampledVoxMap, AChainOfMountingsKeepsTheBricksThatItNeeds) {
  const VoxMap base = buildVoxMap(makeBox({0.012, 0.01, 0.008}), kFineSettings);
  const VoxMap ball = buildVoxMap(makeSphere(0.004, 4), kFineSettings);
  const auto mounted = [&](const VoxMap& on) {
    return mountVoxMap(on, PlacedMap{&ball, Pose::translation({0.005, 0, 0.002})});
  };
  const VoxMap once = mounted(base);
  VoxMap chain = once;
  for (int n = 0; n < 60; ++n) chain = mounted(chain);
  forRandomNodes(5000, 0.011, [&](const Vec3& p) {
    ASSERT_EQ(chain.distance(p), once.distance(p));
    ASSERT_EQ(chain.owner(p), once.owner(p));
  });
  // A pool has memory for twice the bricks of the map and the mounting, and no more. Each brick has 736 nodes
  // and owners of 2 bytes, and 10 bytes more. The cells equal the cells of `once`.
  const double cells_bytes = static_cast<double>(once.memoryBytes());
  EXPECT_LT(static_cast<double>(chain.memoryBytes()),
            2 * 2 * static_cast<double>(chain.brickCount()) * (2 * 736 * 2 + 10) + cells_bytes);
}

TEST(ResampledVoxMap, APartFarFromTheOriginTakesAsLittleMemoryAsOneNearIt) {
  const VoxMap ball = buildVoxMap(makeSphere(0.004, 4), kFineSettings);
  const auto moved = [&](double cells) {
    return resampledVoxMap({&ball, Pose::translation(cells * 8 * kFineVoxel_m * Vec3::Ones())},
                           kFineSettings);
  };
  // A map that is moved by whole cells has the same grid about the part, and the same bricks except for the
  // rounding of positions.
  EXPECT_LT(static_cast<double>(moved(50).memoryBytes()), 1.01 * static_cast<double>(moved(0).memoryBytes()));
  EXPECT_LT(moved(50).distance(50 * 8 * kFineVoxel_m * Vec3::Ones()), 0);
}

TEST(ResampledVoxMap, EachCellThatReadsOneConstantIsThatConstant) {
  // Cells that are set to a constant without reading must read as that constant: every node of the resampled
  // map, also beyond the band, equals the source at its place.
  for (const int seed : {3, 4, 5}) {
    const Pose X = RandomPoints(seed).pose(0.003), X_inverse = X.inverse();
    const VoxMap ring = buildVoxMap(makeTube(0.005, 0.003, 0.006, 64), kFineSettings);
    const VoxMap moved = resampledVoxMap({&ring, X}, kFineSettings);
    const double one_m = 1.01 * moved.quantum_m();  // rounding, twice
    forRandomNodes(40000, 0.012, [&](const Vec3& p) {
      ASSERT_NEAR(moved.distance(p), ring.distance(X_inverse * p), one_m + 1e-4 * kFineVoxel_m);
      if (std::abs(moved.distance(p)) < moved.band_m()) return;
      ASSERT_EQ(moved.distance(p) < 0, ring.distance(X_inverse * p) < 0);
    });
  }
}

TEST(ResampledVoxMap, CullingIsExactOnAResampledMap) {
  const VoxMap source = buildVoxMap(makeBox({0.01, 0.008, 0.006}), kFineSettings);
  const VoxMap moved = resampledVoxMap({&source, RandomPoints(8).pose(0.003)}, kFineSettings);
  const PointShell shell = buildPointShell(makeSphere(0.003, 3), {0.3e-3, 0.35});
  ContactSet culled(shell.size()), all(shell.size());
  RandomPoints random(9);
  std::size_t touching = 0;
  for (int n = 0; n < 300; ++n) {
    const Pose X_MP = random.pose(0.009);
    QueryOptions options;
    options.cutoff_m = n % 2 != 0 ? 0.1e-3 : 0;
    queryContacts(moved, shell, X_MP, options, culled);
    options.is_exhaustive = true;
    queryContacts(moved, shell, X_MP, options, all);
    ASSERT_EQ(culled.contacts.size(), all.contacts.size());
    for (std::size_t i = 0; i < all.contacts.size(); ++i)
      ASSERT_EQ(culled.contacts[i].id, all.contacts[i].id);
    touching += all.contacts.size();
  }
  EXPECT_GT(touching, 1000u);
}

}  // namespace
}  // namespace vps::test
