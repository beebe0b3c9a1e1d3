// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "support/analytic.h"
#include "vps/errors.h"

namespace vps::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Sums of n products of numbers near 1 lose at most n units in the last place.
double rounding(const Mesh& mesh) {
  return 1e-15 * static_cast<double>(mesh.triangles.size());
}

void expectClosed(const Mesh& mesh) {
  const MeshReport report = checkMesh(mesh);
  EXPECT_TRUE(report.isClosed());
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_EQ(report.shells, 1u);
}

TEST(Mesh, BoxHasItsVolumeAreaAndInertia) {
  const Vec3 size(0.03, 0.02, 0.05);
  const Mesh box = makeBox(size);
  expectClosed(box);
  EXPECT_NEAR(area(box), 2 * (0.03 * 0.02 + 0.02 * 0.05 + 0.05 * 0.03), 1e-17);
  const MassProperties mass = massProperties(box);
  const double volume = size.prod();
  EXPECT_NEAR(mass.volume_m3, volume, 1e-14 * volume);
  EXPECT_NEAR(mass.inertia_m5(0, 0), volume * (0.02 * 0.02 + 0.05 * 0.05) / 12, 1e-13 * volume);
  EXPECT_NEAR(mass.inertia_m5(1, 2), 0, 1e-13 * volume);
}

TEST(Mesh, MassPropertiesFollowAPose) {
  const Mesh box = makeBox({0.03, 0.02, 0.05});
  const MassProperties at_home = massProperties(box);
  const Pose X_AB(Quat(0.9, 0.1, -0.3, 0.2), Vec3(2, -1, 3));  // far off: sums about the origin would cancel
  const MassProperties moved = massProperties(transformed(box, X_AB));
  // Vertices 4 m away are rounded to 4e-16 m, 1e-14 of the size; volume and inertia to a few times that.
  EXPECT_NEAR(moved.volume_m3, at_home.volume_m3, 1e-12 * at_home.volume_m3);
  EXPECT_LT((moved.com - X_AB.p).norm(), 1e-14);
  const Mat3 expected = X_AB.R * at_home.inertia_m5 * X_AB.R.transpose();
  EXPECT_LT((moved.inertia_m5 - expected).norm(), 1e-12 * expected.norm());
}

TEST(Mesh, CylinderAndTubeHaveTheVolumeOfTheirPolygons) {
  constexpr int kSegments = 40;
  const double polygon = kSegments / 2.0 * std::sin(2 * kPi / kSegments);  // area in a unit circle
  const Mesh cylinder = makeCylinder(2, 3, kSegments), tube = makeTube(2, 1.5, 3, kSegments);
  expectClosed(cylinder);
  expectClosed(tube);
  EXPECT_NEAR(massProperties(cylinder).volume_m3, 3 * polygon * 4, 3 * 4 * polygon * rounding(cylinder));
  EXPECT_NEAR(massProperties(tube).volume_m3, 3 * polygon * (4 - 2.25), 3 * 4 * polygon * rounding(tube));
}

TEST(Mesh, SphereApproachesItsVolumeAtSecondOrder) {
  const double truth = 4 * kPi / 3;
  double last_error = 0;
  for (int level = 1; level <= 4; ++level) {
    const Mesh sphere = makeSphere(1, level);
    expectClosed(sphere);
    EXPECT_EQ(sphere.triangles.size(), 20u << (2 * level));
    for (const Vec3& p : sphere.vertices) EXPECT_NEAR(p.norm(), 1, 3e-16);
    const double error = truth - massProperties(sphere).volume_m3;
    EXPECT_GT(error, 0);  // inscribed
    if (level > 2) {
      EXPECT_NEAR(last_error / error, 4, 0.2);
    }
    last_error = error;
  }
}

Mesh unshared(const Mesh& mesh, double noise_m) {
  RandomPoints random(1);
  Mesh soup;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t)
      soup.vertices.push_back(mesh.vertices[v] + random.inBox(Vec3::Constant(noise_m)));
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Mesh, WeldingSharesVerticesAgain) {
  const Mesh sphere = makeSphere(0.01, 3);
  const Mesh soup = unshared(sphere, 0);
  EXPECT_EQ(checkMesh(soup).open_edges, 3 * soup.triangles.size());
  const Mesh exact = welded(soup);
  EXPECT_EQ(exact.vertices.size(), sphere.vertices.size());
  expectClosed(exact);
}

TEST(Mesh, WeldingWithToleranceMergesNoisyVertices) {
  const Mesh sphere = makeSphere(0.01, 3);
  const Mesh soup = unshared(sphere, 1e-8);
  EXPECT_FALSE(checkMesh(welded(soup)).isClosed());
  // Two copies of a vertex are at most 2 sqrt(3) 1e-8 apart.
  const Mesh close = welded(soup, 4e-8);
  EXPECT_EQ(close.vertices.size(), sphere.vertices.size());
  expectClosed(close);
}

TEST(Mesh, WeldingMergesBothZeros) {
  Mesh mesh;
  mesh.vertices = {{0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(welded(mesh).vertices.size(), 4u);
}

TEST(Mesh, WeldingDropsTrianglesThatCollapse) {
  Mesh mesh = makeBox({1, 1, 1});
  mesh.vertices.emplace_back(mesh.vertices[0] + Vec3(1e-7, 0, 0));
  mesh.triangles.push_back({0, 8, 1});
  EXPECT_EQ(welded(mesh, 1e-6).triangles.size(), 12u);
}

TEST(Mesh, ReportCountsFaults) {
  Mesh open = makeBox({1, 1, 1});
  open.triangles.pop_back();
  EXPECT_EQ(checkMesh(open).open_edges, 3u);
  EXPECT_FALSE(checkMesh(open).isClosed());

  Mesh flipped = makeBox({1, 1, 1});
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_EQ(checkMesh(flipped).flipped_edges, 3u);

  Mesh fin = makeBox({1, 1, 1});
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
  EXPECT_EQ(checkMesh(fin).non_manifold_edges, 1u);
  EXPECT_EQ(checkMesh(fin).open_edges, 2u);

  Mesh two = makeBox({1, 1, 1});
  append(two, transformed(makeBox({1, 1, 1}), Pose::translation({3, 0, 0})));
  EXPECT_EQ(checkMesh(two).shells, 2u);
  EXPECT_TRUE(checkMesh(two).isClosed());

  Mesh line = makeBox({1, 1, 1});
  line.vertices.emplace_back(0.5 * (line.vertices[0] + line.vertices[1]));
  line.triangles.push_back({0, 8, 1});
  EXPECT_EQ(checkMesh(line).degenerate_triangles, 1u);
}

std::string complaint(const Mesh& mesh) {
  try {
    requireUsable(mesh, "gear.stl", "hub");
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(Mesh, UnusableMeshesAreRefusedWithFilePartAndRemedy) {
  EXPECT_EQ(complaint(makeBox({1, 1, 1})), "");
  EXPECT_EQ(complaint(Mesh{}),
            "gear.stl: part 'hub': the mesh has no triangles; export it as a triangle mesh");
  Mesh mesh = makeBox({1, 1, 1});
  mesh.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(mesh), "gear.stl: part 'hub': vertex 5 is not a number; export it again");
  mesh = makeBox({1, 1, 1});
  mesh.triangles[3][1] = 8;
  EXPECT_NE(complaint(mesh).find("triangle 3 names vertex 8 of 8"), std::string::npos);
  mesh = makeBox({1, 1, 1});
  for (Vec3& p : mesh.vertices) p.z() = p.x();
  for (Vec3& p : mesh.vertices) p.y() = p.x();
  EXPECT_NE(complaint(mesh).find("zero area"), std::string::npos);
  mesh = makeBox({1e200, 1e200, 1e200});
  EXPECT_NE(complaint(mesh).find("too large"), std::string::npos);
}

}  // namespace
}  // namespace vps::test
