// SPDX-License-Identifier: BSD-3-Clause
// The file has more than 400 lines because all tests of single voxmaps share its helpers.
#include "vps/voxmap.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/analytic.h"
#include "vps/errors.h"
#include "vps/mesh_distance.h"
#include "vps/solid.h"

namespace vps::test {
namespace {

constexpr double kVoxel_m = 0.5e-3;
constexpr VoxMapSettings kSettings = {kVoxel_m, 4};

/// Calls visit with every grid node within `reach` voxels of a map's part.
void forEachNode(const VoxMap& map, int reach, const std::function<void(const Vec3&)>& visit) {
  const double h = map.voxel_m();
  const Eigen::Array3i low = (map.bounds().min / h).array().floor().cast<int>() - reach;
  const Eigen::Array3i high = (map.bounds().max / h).array().ceil().cast<int>() + reach;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) visit(h * Vec3(x, y, z));
}

/// Every node has the exact distance to the mesh, rounded to a quantum, clamped to the band and with the
/// right sign. The hundredth of a quantum is for the floats in which distances are computed.
void expectNodesExact(const Mesh& mesh, const VoxMapSettings& settings = kSettings) {
  const VoxMap map = buildVoxMap(mesh, settings);
  const MeshDistance truth(welded(mesh));
  forEachNode(map, 8, [&](const Vec3& p) {
    const double expected_m = std::clamp(truth.signedDistance(p), -map.band_m(), map.band_m());
    ASSERT_NEAR(map.distance(p), expected_m, 0.51 * map.quantum_m()) << p.transpose() / map.voxel_m();
    // On the surface up to rounding the sign is arbitrary.
    if (std::abs(expected_m) > 0.51 * map.quantum_m()) {
      ASSERT_EQ(map.distance(p) < 0, expected_m < 0) << p.transpose() / map.voxel_m();
    }
  });
}

TEST(VoxMap, NodesOfATurnedBoxAreExact) {
  expectNodesExact(transformed(makeBox({0.02, 0.015, 0.01}), RandomPoints(1).pose(0.01)));
}
TEST(VoxMap, NodesOfABoxOnTheGridAreExact) {
  expectNodesExact(makeBox({0.016, 0.008, 0.012}));
}
TEST(VoxMap, NodesOfASphereAreExact) {
  expectNodesExact(makeSphere(0.008, 4));
}
TEST(VoxMap, NodesOfATubeAreExact) {
  expectNodesExact(transformed(makeTube(0.01, 0.006, 0.012, 48), RandomPoints(2).pose(0.01)));
}
TEST(VoxMap, NodesOfSliversAreExact) {
  expectNodesExact(makeTube(0.008, 0.005, 0.01, 3000));
}
TEST(VoxMap, NodesOfATinyPartAreExact) {
  expectNodesExact(makeSphere(0.2e-3, 2));
}
TEST(VoxMap, NodesOfAThinPlateAreExact) {  // its thickness is a fifth of a voxel
  expectNodesExact(transformed(makeBox({0.01, 0.008, 0.1e-3}), RandomPoints(3).pose(0.001)));
}
TEST(VoxMap, NodesOfASpikeAreExact) {
  Mesh needle;
  needle.vertices = {{-1e-3, -1e-3, 0}, {1e-3, -1e-3, 0}, {0, 1e-3, 0}, {5e-3, 3e-3, 0.015}};
  needle.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  expectNodesExact(needle);
}
TEST(VoxMap, NodesAreExactAtEveryScale) {  // parts of 1 um, of 100 m and of atomic size
  const Mesh tube = transformed(makeTube(1, 0.6, 1.2, 48), RandomPoints(26).pose(1));
  for (const double scale : {0.5e-6, 50.0, 1e-12}) {
    Mesh scaled = tube;
    for (Vec3& p : scaled.vertices) p *= scale;
    expectNodesExact(scaled, {0.05 * scale, 4});
  }
}
TEST(VoxMap, ANodeWithinHalfAQuantumOfTheSurfaceReadsZeroAndTheSolidTellsItsSide) {
  const double h = 0.5e-3, quantum_m = buildVoxMap(makeBox(Vec3::Constant(0.02)), {h, 4}).quantum_m();
  for (const double quanta : {-1.4, -0.55, -0.45, -0.01, 0.01, 0.45, 0.55, 1.4}) {
    // The node (20, 0, 0) is this far outside of the box.
    const Vec3 node(20 * h, 0, 0);
    const Mesh box = makeBox(2 * Vec3(20 * h - quanta * quantum_m, 0.01, 0.01));
    const VoxMap map = buildVoxMap(box, {h, 4});
    ASSERT_NEAR(map.quantum_m(), quantum_m, 1e-12 * quantum_m);
    EXPECT_NEAR(map.distance(node), std::round(quanta) * quantum_m, 1e-6 * quantum_m) << quanta;
    EXPECT_EQ(Solid(box).signedDistance(node) < 0, quanta < 0) << quanta;
  }
}
TEST(VoxMap, NodesOfAWideBandAreExact) {
  expectNodesExact(transformed(makeBox({0.006, 0.004, 0.002}), RandomPoints(27).pose(0.01)), {kVoxel_m, 20});
}
TEST(VoxMap, UnsharedVerticesMakeNoDifference) {
  const Mesh box = transformed(makeBox({0.01, 0.008, 0.006}), RandomPoints(4).pose(0.001));
  Mesh soup;
  for (const auto& t : box.triangles) {
    for (const std::uint32_t v : t) soup.vertices.push_back(box.vertices[v]);
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  expectNodesExact(soup);
}

TEST(VoxMap, SphereReportsItsAnalyticDistance) {
  constexpr double kRadius_m = 0.01;
  const VoxMap map = buildVoxMap(makeSphere(kRadius_m, 5), kSettings);
  // Error of trilinear interpolation: h^2/8 times the summed second derivatives, 2/r for a sphere, r least at
  // the band's inner edge.
  const double interpolation_m = kVoxel_m * kVoxel_m / 8 * 2 / (kRadius_m - map.band_m());
  // Facets: the icosahedron's edge of 1.051 r is halved five times, and at most 1.15 times longer where it
  // bulges. A circumradius is edge / sqrt(3), and the sagitta is circumradius^2 / (2 r).
  const double edge_m = 1.051 * 1.15 * kRadius_m / 32, facet_m = edge_m * edge_m / 3 / (2 * kRadius_m);
  RandomPoints random(5);
  int near = 0;
  for (int n = 0; n < 50000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.013));
    const double truth_m = sphereDistance(p, kRadius_m);
    // In the last voxel of the band saturated nodes enter the interpolation.
    if (std::abs(truth_m) > map.band_m() - 2 * kVoxel_m) continue;
    ASSERT_NEAR(map.distance(p), truth_m, interpolation_m + facet_m);
    ++near;
  }
  EXPECT_GT(near, 5000);
}

TEST(VoxMap, CylinderAndBoxReportTheirAnalyticDistanceOnFaces) {
  constexpr double kRadius_m = 0.008, kHeight_m = 0.02;
  constexpr int kSegments = 512;
  const VoxMap cylinder = buildVoxMap(makeCylinder(kRadius_m, kHeight_m, kSegments), kSettings);
  const Vec3 half(0.008, 0.006, 0.01);
  const VoxMap box = buildVoxMap(makeBox(2 * half), kSettings);
  RandomPoints random(6);
  for (int n = 0; n < 20000; ++n) {
    // Near the middle of the mantle: curvature 1/r in one direction.
    const double angle_rad = 3.2 * random.unit(), depth_m = kVoxel_m * random.unit();
    const double r = kRadius_m - depth_m;
    const Vec3 p(r * std::cos(angle_rad), r * std::sin(angle_rad), 0.005 * random.unit());
    const double tolerance_m =
        kVoxel_m * kVoxel_m / (8 * (kRadius_m - 3 * kVoxel_m)) + sagitta(kRadius_m, kSegments);
    ASSERT_NEAR(cylinder.distance(p), depth_m * -1, tolerance_m);
    // Near a face and away from its edges the distance is linear, so it is exact except for the nodes'
    // rounding.
    const Vec3 q = Vec3(0, 0, half.z()) + random.inBox({0.005, 0.003, kVoxel_m});
    ASSERT_NEAR(box.distance(q), boxDistance(q, half), 0.51 * box.quantum_m());
    // Nodes of equal distance are rounded equally, so there is no slope along the plane.
    ASSERT_LT((box.normal(q) - Vec3::UnitZ()).norm(), 1e-6);
    ASSERT_LT((box.normal(q, Gradient::Trilinear) - Vec3::UnitZ()).norm(), 1e-6);
  }
}

TEST(VoxMap, NormalsOfASphereAreRadial) {
  constexpr double kRadius_m = 0.01;
  const VoxMap map = buildVoxMap(makeSphere(kRadius_m, 6), kSettings);
  RandomPoints random(7);
  // Second differences of a distance with curvature 1/r: the trilinear gradient is off by about h/r within a
  // cell, and facets (edge e) turn it by e/r. Averaging over two voxels adds at most the same error again.
  const double edge_m = 1.051 * 1.15 * kRadius_m / 64;
  const double tolerance_rad = (kVoxel_m + edge_m) / (kRadius_m - kVoxel_m);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 radial = random.inBox(Vec3::Ones()).normalized();
    const Vec3 p = (kRadius_m + kVoxel_m * random.unit()) * radial;
    ASSERT_LT((map.normal(p) - radial).norm(), tolerance_rad);
    ASSERT_LT((map.normal(p, Gradient::Trilinear) - radial).norm(), tolerance_rad);
  }
}

TEST(VoxMap, TrilinearNormalIsTheDerivativeOfTheDistance) {
  const VoxMap map =
      buildVoxMap(transformed(makeBox({0.01, 0.008, 0.012}), RandomPoints(8).pose(0.001)), kSettings);
  RandomPoints random(9);
  const double step_m = 1e-3 * kVoxel_m;
  int compared = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = map.bounds().center() + random.inBox(0.6 * map.bounds().size());
    const Eigen::Array3d t = p.array() / kVoxel_m - (p.array() / kVoxel_m).floor();
    if (t.minCoeff() < 0.01 || t.maxCoeff() > 0.99) continue;  // both samples in one cell
    const Vec3 n_M = map.normal(p, Gradient::Trilinear);
    if (n_M.isZero()) continue;
    Vec3 difference;
    for (int axis = 0; axis < 3; ++axis)
      difference[axis] =
          map.distance(p + step_m * Vec3::Unit(axis)) - map.distance(p - step_m * Vec3::Unit(axis));
    if (difference.norm() < 0.1 * step_m) continue;  // nearly cancelled: its direction is noise
    // The distance is linear along each axis, so its difference is exact except for rounding: 1e-16 of 1e-3 m
    // over a step of 5e-7 m.
    ASSERT_LT((n_M - difference.normalized()).norm(), 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 2000);
}

TEST(VoxMap, DistanceIsContinuous) {
  const VoxMap map =
      buildVoxMap(transformed(makeTube(0.01, 0.006, 0.02, 64), RandomPoints(10).pose(0.01)), kSettings);
  RandomPoints random(11);
  const double step_m = 0.01 * kVoxel_m;
  for (int line = 0; line < 60; ++line) {
    Vec3 p = map.bounds().center() + random.inBox(0.7 * map.bounds().size());
    const Vec3 step = step_m * random.inBox(Vec3::Ones()).normalized();
    double last_m = map.distance(p);
    for (int n = 0; n < 3000; ++n) {
      p += step;
      const double d = map.distance(p);
      // Each partial derivative is at most 1, as a mean of differences of neighbours; the gradient is at most
      // sqrt(3).
      ASSERT_LE(std::abs(d - last_m), std::sqrt(3.0) * step_m + 1e-7 * map.band_m());
      last_m = d;
    }
  }
}

TEST(VoxMap, TheContinuousNormalIsContinuous) {
  constexpr double kRadius_m = 0.01;
  const VoxMap map = buildVoxMap(makeSphere(kRadius_m, 5), kSettings);
  RandomPoints random(12);
  const double step_m = 0.01 * kVoxel_m;
  for (int line = 0; line < 200; ++line) {
    Vec3 p = kRadius_m * random.inBox(Vec3::Ones()).normalized();
    const Vec3 step = step_m * random.inBox(Vec3::Ones()).normalized();
    Vec3 last = map.normal(p);
    for (int n = 0; n < 100; ++n) {
      p += step;
      const Vec3 n_M = map.normal(p);
      // Nodal gradients of neighbours differ by about h/r, and gradients a hundredth of a voxel apart differ
      // by h/100r; the factor 4 is for diagonals and facets. A jump between cells would be h/r.
      ASSERT_LT((n_M - last).norm(), 4 * 0.01 * kVoxel_m / (kRadius_m - 2 * kVoxel_m));
      last = n_M;
    }
  }
}

TEST(VoxMap, BoundsHoldEverywhere) {
  for (const Mesh& mesh :
       {makeSphere(0.012, 4), transformed(makeTube(0.012, 0.005, 0.02, 40), RandomPoints(13).pose(0.02)),
        makeBox({0.03, 0.002, 0.02})}) {
    const VoxMap map = buildVoxMap(mesh, kSettings);
    const MeshDistance truth(mesh);
    RandomPoints random(14);
    double shortfall_m = 0;
    for (int n = 0; n < 20000; ++n) {
      const Vec3 p = map.bounds().center() + random.inBox((n % 2 ? 0.7 : 3) * map.bounds().size());
      const double d = truth.signedDistance(p);
      ASSERT_LE(map.lowerBound(p), std::abs(d));
      ASSERT_GE(map.lowerBound(p), 0);
      ASSERT_LE(map.leastDistance(p), std::max(d, -map.band_m()));
      ASSERT_LE(std::abs(map.distance(p) - std::clamp(d, -map.band_m(), map.band_m())), map.sampleError_m());
      if (std::abs(d) > map.band_m()) {
        ASSERT_EQ(map.isInsideCoarse(p), d < 0);
      }
      // Farther away, only the distance to the directory is accurate.
      if (n % 2) shortfall_m = std::max(shortfall_m, std::abs(d) - map.lowerBound(p));
    }
    // A cell's half diagonal, twice (from the centre to the point, and to the surface beyond it), and a tenth
    // of the depth.
    EXPECT_LT(shortfall_m, 2 * std::sqrt(3.0) * 4 * kVoxel_m + 0.1 * map.bounds().size().norm());
  }
}

TEST(VoxMap, FarPointsAndNaNAreOutside) {
  const VoxMap map = buildVoxMap(makeBox({0.01, 0.01, 0.01}), kSettings);
  EXPECT_EQ(map.distance({1e9, 0, 0}), map.band_m());
  EXPECT_EQ(map.distance({std::nan(""), 0, 0}), map.band_m());
  EXPECT_EQ(map.distance({0, 0, 0}), -map.band_m());
  EXPECT_TRUE(map.normal({0, 0, 0}).isZero());
  EXPECT_TRUE(map.normal({1, 0, 0}).isZero());
  EXPECT_NEAR(map.lowerBound({10, 0, 0}), 10 - 0.005, 0.01);
  EXPECT_TRUE(map.isInsideCoarse({0, 0, 0}));
  EXPECT_FALSE(map.isInsideCoarse({0.02, 0, 0}));
  const VoxMap none;
  EXPECT_EQ(none.distance({0, 0, 0}), 0);
  EXPECT_EQ(none.brickCount(), 0u);
}

TEST(VoxMap, SampleIsDistanceAndNormal) {
  const VoxMap map = buildVoxMap(makeSphere(0.01, 3), kSettings);
  RandomPoints random(15);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.013));
    const VoxMap::Sample sample = map.sample(p);
    EXPECT_EQ(sample.distance_m, map.distance(p));
    EXPECT_EQ(sample.normal, map.normal(p));
  }
}

TEST(VoxMap, ManyThreadsGiveTheBitsOfOneThread) {
  const Mesh mesh = transformed(makeTube(0.01, 0.006, 0.02, 200), RandomPoints(17).pose(0.01));
  const VoxMap many = buildVoxMap(mesh, kSettings);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expectSame(buildVoxMap(mesh, kSettings), many);
}

TEST(VoxMap, AShiftByWholeVoxelsShiftsTheMap) {
  const Mesh mesh = transformed(makeBox({0.01, 0.008, 0.006}), RandomPoints(18).pose(0.001));
  const Vec3 shift = kVoxel_m * Vec3(5, -3, 17);
  const VoxMap at_home = buildVoxMap(mesh, kSettings);
  const VoxMap moved = buildVoxMap(transformed(mesh, Pose::translation(shift)), kSettings);
  RandomPoints random(19);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.01));
    // The shift itself is rounded, to 1e-18; floats round distances to 6e-8 of the band.
    ASSERT_NEAR(moved.distance(p + shift), at_home.distance(p), 2e-7 * at_home.band_m());
  }
}

TEST(VoxMap, ARigidMotionChangesNoMoreThanInterpolation) {
  const Mesh mesh = makeTube(0.01, 0.006, 0.012, 64);
  const Pose X_AB = RandomPoints(20).pose(0.02);
  const VoxMap a = buildVoxMap(mesh, kSettings), b = buildVoxMap(transformed(mesh, X_AB), kSettings);
  RandomPoints random(21);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.012));
    ASSERT_NEAR(a.distance(p), b.distance(X_AB * p), 2 * a.sampleError_m());
  }
}

class CookedVoxMap : public testing::Test {
 protected:
  const Mesh tube_ = makeTube(0.01, 0.006, 0.012, 64), pin_ = makeCylinder(0.006, 0.03, 64);
  const Mesh far_ = makeBox({0.006, 0.004, 0.008});
  const Pose X_tube_ = Pose::translation({0.1e-3, 0, 0});
  const Pose X_pin_ = Pose(Quat(0.99, 0.1, 0, 0.05), Vec3(0, 0.2e-3, 0.004));
  const Pose X_far_ = Pose(Quat(0.9, 0.1, 0.3, 0.2), Vec3(-0.05, 0.01, 0.03));
  const std::vector<PlacedMesh> parts_ = {{&tube_, X_tube_}, {&pin_, X_pin_}, {&far_, X_far_}};
};

TEST_F(CookedVoxMap, NodesAreTheMinimumOverTheParts) {
  const VoxMap cooked = cookVoxMap(parts_, kSettings);
  std::vector<MeshDistance> truths;
  for (const PlacedMesh& part : parts_) truths.emplace_back(transformed(*part.mesh, part.X_MP));
  forEachNode(cooked, 2, [&](const Vec3& p) {
    double least_m = cooked.band_m();
    std::size_t owner = 0;
    double second_m = cooked.band_m();
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const double d = std::max(truths[i].signedDistance(p), -cooked.band_m());
      if (d < least_m) {
        second_m = least_m;
        least_m = d;
        owner = i;
      } else {
        second_m = std::min(second_m, d);
      }
    }
    ASSERT_NEAR(cooked.distance(p), least_m, 0.51 * cooked.quantum_m());
    if (cooked.band_m() - std::abs(least_m) > cooked.quantum_m() &&
        second_m - least_m > 1.1 * cooked.quantum_m()) {  // otherwise they round to one number
      ASSERT_EQ(cooked.owner(p), owner) << p.transpose();
    }
    ASSERT_LE(cooked.lowerBound(p), std::abs(least_m) < cooked.band_m() ? std::abs(least_m) : 1);
  });
}

TEST_F(CookedVoxMap, MountingOneByOneGivesTheSameBits) {
  const VoxMap cooked = cookVoxMap(parts_, kSettings);
  VoxMap mounted = cookVoxMap({parts_[0]}, kSettings);
  mounted = mountVoxMap(mounted, parts_[1]);
  mounted = mountVoxMap(mounted, parts_[2]);
  expectSame(cooked, mounted);
  RandomPoints random(22);
  for (int n = 0; n < 10000; ++n) {
    const Vec3 p = cooked.bounds().center() + random.inBox(cooked.bounds().size());
    ASSERT_EQ(cooked.owner(p), mounted.owner(p));
  }
}

TEST_F(CookedVoxMap, TheOrderOfMountingDoesNotMatter) {
  expectSame(cookVoxMap(parts_, kSettings), cookVoxMap({parts_[2], parts_[1], parts_[0]}, kSettings));
}

TEST_F(CookedVoxMap, MountingLeavesTheOldMapAsItWas) {
  const VoxMap before = cookVoxMap({parts_[0]}, kSettings);
  const double d = before.distance({0, 0, 0});
  const std::size_t bricks = before.brickCount();
  const VoxMap after = mountVoxMap(before, parts_[1]);
  EXPECT_EQ(before.distance({0, 0, 0}), d);
  EXPECT_EQ(before.brickCount(), bricks);
  EXPECT_LT(after.distance({0, 0, 0}), 0);
  EXPECT_GT(d, 0);
}

TEST_F(CookedVoxMap, BoundsHoldForTheUnion) {
  const VoxMap cooked = cookVoxMap(parts_, kSettings);
  std::vector<MeshDistance> truths;
  for (const PlacedMesh& part : parts_) truths.emplace_back(transformed(*part.mesh, part.X_MP));
  RandomPoints random(23);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = cooked.bounds().center() + random.inBox(1.5 * cooked.bounds().size());
    double d = 1e300;
    for (const MeshDistance& truth : truths) d = std::min(d, truth.signedDistance(p));
    ASSERT_LE(cooked.lowerBound(p), std::abs(d));
    ASSERT_LE(cooked.leastDistance(p), std::max(d, -cooked.band_m()));
    if (std::abs(d) > cooked.band_m()) {
      ASSERT_EQ(cooked.isInsideCoarse(p), d < 0);
    }
  }
}

TEST(VoxMap, UnusableSettingsAreRefusedWithARemedy) {
  const auto complaint = [](const Mesh& mesh, const VoxMapSettings& settings) -> std::string {
    try {
      buildVoxMap(mesh, settings, "hub");
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  };
  const Mesh box = makeBox({0.01, 0.01, 0.01});
  EXPECT_NE(complaint(box, {0, 4}).find("part 'hub': the voxel size"), std::string::npos);
  EXPECT_NE(complaint(box, {std::nan(""), 4}).find("voxel size"), std::string::npos);
  EXPECT_NE(complaint(box, {1e-3, 2}).find("band"), std::string::npos);
  EXPECT_NE(complaint(Mesh{}, kSettings).find("no triangles"), std::string::npos);
  EXPECT_NE(complaint(box, {1e-7, 4}).find("would fit"), std::string::npos);
  EXPECT_NE(complaint(makeBox({1e6, 1e6, 1e6}), {1e-7, 4}).find("would fit"), std::string::npos);
  EXPECT_THROW(cookVoxMap(std::vector<PlacedMesh>{}, kSettings), LoadError);
}

TEST(VoxMap, TheVoxelSizeNamedInTheErrorFits) {
  const Mesh box = makeBox({0.1, 0.1, 0.1});
  try {
    buildVoxMap(box, {1e-8, 4});
    FAIL();
  } catch (const LoadError& error) {
    double fits_mm = 0;
    const std::string text = error.what();
    ASSERT_EQ(
        std::sscanf(text.c_str() + text.find("is 4 GiB; ") + 10, "voxels of %lf mm would fit", &fits_mm), 1)
        << text;
    EXPECT_GT(fits_mm, 1e-3);
    EXPECT_LT(fits_mm, 0.1);
  }
}

}  // namespace
}  // namespace vps::test
