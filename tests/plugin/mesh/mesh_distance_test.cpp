// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/analytic.h"

namespace vps::test {
namespace {

TEST(ClosestOnTriangle, NamesTheFeatureOfEachRegion) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto at = [&](double x, double y) { return closestOnTriangle({x, y, 2}, a, b, c); };
  EXPECT_EQ(at(1, 1).feature, 0);
  EXPECT_EQ(at(2, -1).feature, 1);
  EXPECT_EQ(at(3, 3).feature, 2);
  EXPECT_EQ(at(-1, 2).feature, 3);
  EXPECT_EQ(at(-1, -1).feature, 4);
  EXPECT_EQ(at(6, -1).feature, 5);
  EXPECT_EQ(at(-1, 6).feature, 6);
  EXPECT_LT((at(1, 1).q - Vec3(1, 1, 0)).norm(), 1e-15);
  EXPECT_LT((at(3, 3).q - Vec3(2, 2, 0)).norm(), 1e-15);
}

TEST(ClosestOnTriangle, NoPointOfTheTriangleIsCloser) {
  RandomPoints random(2);
  const Vec3 one = Vec3::Ones();
  for (int n = 0; n < 300; ++n) {
    const Vec3 a = random.inBox(one), b = random.inBox(one), c = random.inBox(one), p = random.inBox(2 * one);
    const double distance = (p - closestOnTriangle(p, a, b, c).q).norm();
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j) {
        const Vec3 q = a + i / 20.0 * (b - a) + j / 20.0 * (c - a);
        ASSERT_LE(distance, (p - q).norm() + 1e-15);
      }
  }
}

TEST(ClosestOnTriangle, ATriangleWithCollinearCornersIsItsEdges) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(3, 0, 0);
  for (const double x : {-1.0, 0.5, 1.0, 2.0, 4.0}) {
    const Vec3 q = closestOnTriangle({x, 1, 0}, a, b, c).q;
    EXPECT_LT((q - Vec3(std::clamp(x, 0.0, 3.0), 0, 0)).norm(), 1e-15) << x;
  }
  EXPECT_EQ(closestOnTriangle({1, 2, 3}, a, a, a).q, a);
}

/// Expects the triangle that an exhaustive search finds nearest; of equally near triangles the first.
void expectExhaustiveSearch(const Mesh& mesh, const std::vector<Vec3>& points) {
  const MeshDistance distance(mesh);
  for (const Vec3& p : points) {
    SCOPED_TRACE(testing::Message() << mesh.triangles.size() << " triangles, from " << p.transpose());
    double least2 = 1e300;
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& t = mesh.triangles[i];
      const Vec3 q = closestOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).q;
      const double distance2 = (p - q).squaredNorm();
      if (distance2 < least2) nearest = i;
      least2 = std::min(least2, distance2);
    }
    const MeshDistance::Closest closest = distance.closest(p);
    ASSERT_TRUE(closest.found);
    ASSERT_EQ(closest.distance_m, std::sqrt(least2));
    ASSERT_EQ(closest.triangle, nearest);
    ASSERT_EQ(distance.closest(p, (1 + 1e-12) * closest.distance_m + 1e-12).triangle, nearest);
  }
}

std::vector<Vec3> randomPoints(std::uint64_t seed, int count, double half_m) {
  RandomPoints random(seed);
  std::vector<Vec3> points;
  for (int n = 0; n < count; ++n) points.push_back(random.inBox(Vec3::Constant(half_m)));
  return points;
}

TEST(MeshDistance, EqualsAnExhaustiveSearchOfTheTriangles) {
  const Mesh tube = transformed(makeTube(0.02, 0.01, 0.03, 37), RandomPoints(3).pose(0.01));
  expectExhaustiveSearch(tube, randomPoints(4, 2000, 0.05));
}

TEST(MeshDistance, OfTrianglesEquallyNearTheFirstIsTheNearest) {
  // Coordinates are exact, so the distances of points above corners, edges and centres are equal to the bit.
  Mesh grid;
  constexpr std::uint32_t kSide = 24;
  for (std::uint32_t i = 0; i <= kSide; ++i)
    for (std::uint32_t j = 0; j <= kSide; ++j) grid.vertices.emplace_back(i, j, (i + j) % 2 == 0 ? 0 : 1);
  for (std::uint32_t i = 0; i < kSide; ++i)
    for (std::uint32_t j = 0; j < kSide; ++j) {
      const std::uint32_t at = i * (kSide + 1) + j, beyond = at + kSide + 1;
      grid.triangles.push_back({at, beyond, beyond + 1});
      grid.triangles.push_back({at, beyond + 1, at + 1});
    }
  Mesh reversed = grid;
  std::reverse(reversed.triangles.begin(), reversed.triangles.end());
  std::vector<Vec3> points;
  for (int i = 0; i <= 2 * static_cast<int>(kSide); i += 3)
    for (int j = 0; j <= 2 * static_cast<int>(kSide); j += 3)
      for (const double z : {-2.0, 0.5, 3.0}) points.emplace_back(0.5 * i, 0.5 * j, z);
  expectExhaustiveSearch(grid, points);
  expectExhaustiveSearch(reversed, points);
}

TEST(MeshDistance, FindsTheNearestInTreesThatDivideUnevenly) {
  // Three meshes: in the first, each triangle is smaller than the one before, so that divisions by area split
  // off few triangles and the tree reaches the levels that divide by count; in the second, all triangles are
  // equal, so that no division separates them; in the third, one triangle is larger than all others together.
  Mesh shrinking, alike, mixed;
  const auto add = [](Mesh& mesh, const Vec3& at, double size_m) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(at);
    mesh.vertices.push_back(at + Vec3(size_m, 0, 0.1 * size_m));
    mesh.vertices.push_back(at + Vec3(0, size_m, 0));
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int n = 0; n < 3000; ++n) {
    add(shrinking, Vec3(std::pow(0.8, n), 0, 0), 0.1 * std::pow(0.8, n));
    add(alike, Vec3::Zero(), 1);
    add(mixed, Vec3(0.0003 * n, 0, 0.3), 1e-4);
  }
  add(mixed, Vec3::Constant(-2), 4);
  for (const Mesh* mesh : {&shrinking, &alike, &mixed}) {
    std::vector<Vec3> points = randomPoints(5, 100, 1.5);
    for (int n = 0; n < 100; ++n) points.push_back(mesh->vertices[static_cast<std::size_t>(89 * n)] * 1.01);
    expectExhaustiveSearch(*mesh, points);
  }
}

TEST(MeshDistance, SignedDistanceToABoxIsItsFormula) {
  const Vec3 half(0.015, 0.01, 0.025);
  const MeshDistance distance(makeBox(2 * half));
  RandomPoints random(5);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = random.inBox(2 * half);
    // A few roundings of coordinates below 0.1.
    ASSERT_NEAR(distance.signedDistance(p), boxDistance(p, half), 1e-16);
  }
}

TEST(MeshDistance, SignIsRightAtSharpSpikesWhereFaceNormalsFail) {
  // A needle: near its tip the nearest feature is the vertex, and some faces around it face away.
  Mesh needle;
  needle.vertices = {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0, 0.1, 0}, {0.5, 0.3, 2}};
  needle.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const MeshDistance distance(needle);
  RandomPoints random(6);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = needle.vertices[3] + random.inBox(Vec3::Constant(0.3));
    bool is_inside = true;  // convex: inside is below all four planes
    for (const auto& t : needle.triangles) {
      const Vec3& a = needle.vertices[t[0]];
      is_inside = is_inside && (needle.vertices[t[1]] - a).cross(needle.vertices[t[2]] - a).dot(p - a) < 0;
    }
    ASSERT_EQ(distance.signedDistance(p) < 0, is_inside) << p.transpose();
  }
}

/// A blade along y whose ridge x = 0, z = 1 has a corner C in its middle on one side only. A triangle without
/// area, ACB, fills the crack.
Mesh bladeWithCollinearFiller(double half_width) {
  Mesh mesh;
  const double w = half_width;
  mesh.vertices = {{0, -1, 1}, {0, 1, 1}, {0, 0.1, 1}, {-w, -1, 0}, {-w, 1, 0}, {w, -1, 0}, {w, 1, 0}};
  enum : std::uint32_t { A, B, C, L0, L1, R0, R1 };
  mesh.triangles = {{A, B, L1},   {A, L1, L0},               // left flank: the whole ridge
                    {A, R0, C},   {C, R0, R1},  {C, R1, B},  // right flank, with C
                    {A, C, B},                               // the filler
                    {L0, L1, R1}, {L0, R1, R0},              // bottom
                    {A, L0, R0},  {B, R1, L1}};              // ends
  return mesh;
}

TEST(MeshDistance, SignIsRightNextToTrianglesWithoutArea) {
  const Mesh plain = bladeWithCollinearFiller(0.1);
  ASSERT_TRUE(checkMesh(plain).isClosed());
  ASSERT_GT(massProperties(plain).volume_m3, 0);
  for (const int seed : {1, 2, 3}) {
    const Pose X = RandomPoints(seed).pose(1);  // rounding moves C off the line
    const MeshDistance blade(transformed(plain, X));
    RandomPoints random(seed + 10);
    for (int n = 0; n < 20000; ++n) {
      const Vec3 p = Vec3(0, 0, 0.9) + random.inBox({0.3, 0.9, 0.4});
      const bool is_inside = p.z() > 0 && std::abs(p.x()) < 0.1 * (1 - p.z());
      ASSERT_EQ(blade.signedDistance(X * p) < 0, is_inside) << p.transpose();
    }
  }
}

TEST(MeshDistance, BeyondTheLimitNothingIsFound) {
  const MeshDistance distance(makeBox({2, 2, 2}));
  EXPECT_FALSE(distance.closest({3, 0, 0}, 1.9).found);
  EXPECT_EQ(distance.closest({3, 0, 0}, 1.9).distance_m, 1.9);
  EXPECT_TRUE(distance.closest({3, 0, 0}, 2.1).found);
  EXPECT_EQ(distance.signedDistance({0, 0, 0}, 0.5), 0.5);
  EXPECT_EQ(distance.signedDistance({0, 0, 0}), -1);
}

TEST(MeshDistance, LowerBoundIsWithinItsSlack) {
  const MeshDistance distance(makeSphere(0.02, 4));
  RandomPoints random(7);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random.inBox(Vec3::Constant(0.05));
    const double truth_m = distance.closest(p).distance_m, bound_m = distance.lowerBound(p, 0.1);
    ASSERT_LE(bound_m, truth_m);
    ASSERT_GE(bound_m * 1.1, truth_m * (1 - 1e-15));
  }
}

TEST(MeshDistance, ABoxBeyondTheRangeOfFloatsOverlapsAllTriangles) {
  const Mesh sphere = makeSphere(0.02, 2);
  Box all;
  all.add(Vec3::Constant(-1e300));
  all.add(Vec3::Constant(1e300));
  std::vector<std::uint32_t> triangles;
  EXPECT_TRUE(MeshDistance(sphere).overlapping(all, sphere.triangles.size(), triangles));
  EXPECT_EQ(triangles.size(), sphere.triangles.size());
}

TEST(MeshDistance, AnEmptyMeshIsInfinitelyFar) {
  EXPECT_FALSE(MeshDistance(Mesh{}).closest(Vec3::Zero()).found);
}

TEST(MeshDistance, TheSmoothNormalOfATubeIsThatOfTheTrueCylinder) {
  constexpr int kSegments = 48;
  const double r_m = 0.01, inner_m = 0.006, half_z_m = 0.01;
  const MeshDistance distance(makeTube(r_m, inner_m, 2 * half_z_m, kSegments));
  // Along a chord, with q at (r cos h, x r sin h) for x from -1 to 1, the corners' normals (cos h, -+ sin h)
  // interpolate to (cos h, x sin h): parallel to q, so only their rounding to float remains. The facet's own
  // normal is off by up to pi / 48.
  const double tol = 2e-7;
  const auto radial = [](const Vec3& q) { return Vec3(q.x(), q.y(), 0).normalized(); };
  RandomPoints random(5);
  for (int n = 0; n < 500; ++n) {
    const double angle_rad = random.unit() * std::numbers::pi, z_m = random.unit() * half_z_m * 0.999;
    const Vec3 out(std::cos(angle_rad), std::sin(angle_rad), 0), up(0, 0, 1);
    const MeshDistance::Closest outer = distance.closest(1.1 * r_m * out + z_m * up);
    EXPECT_LE((distance.smoothNormal(outer.triangle, outer.q) - radial(outer.q)).norm(), tol);
    const MeshDistance::Closest inner = distance.closest(0.9 * inner_m * out + z_m * up);
    EXPECT_LE((distance.smoothNormal(inner.triangle, inner.q) + radial(inner.q)).norm(), tol);
    // The end face meets the wall at 90 degrees, so its normal does not bend towards the wall.
    const MeshDistance::Closest end = distance.closest(0.5 * (r_m + inner_m) * out + 1.5 * half_z_m * up);
    EXPECT_EQ(distance.smoothNormal(end.triangle, end.q), up);
  }
}

TEST(MeshDistance, TheSmoothNormalOfAFlankIsNormalToItsHelices) {
  // A flank of a V thread, open, as between its sharp crest and root. The facets' angles before and after a
  // vertex differ; normals weighted only by these angles leaned by 0.003 along the thread.
  constexpr int kSegments = 50;
  const double lead_m = 3.8e-3, r_m[2] = {5.7e-3, 7.6e-3}, z_m[2] = {1.9e-3, 0};
  Mesh flank;
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kSegments;
    for (int k = 0; k < 2; ++k)
      flank.vertices.emplace_back(r_m[k] * std::cos(angle_rad), r_m[k] * std::sin(angle_rad),
                                  z_m[k] + lead_m * i / kSegments);
    if (i == 0) continue;
    const std::uint32_t v = 2 * i - 2;  // root and crest before, root and crest after
    flank.triangles.push_back({v, v + 1, v + 3});
    flank.triangles.push_back({v, v + 3, v + 2});
  }
  const MeshDistance distance(flank);
  // Over a step h of a helix of slope s, the parabola's tangent has the slope s h / sin h. Normals are
  // floats.
  const double h_rad = 2 * std::numbers::pi / kSegments, slope = lead_m / (2 * std::numbers::pi * r_m[0]);
  const double tol = slope * (h_rad / std::sin(h_rad) - 1) + 2e-7;
  for (std::uint32_t triangle = 4; triangle + 4 < flank.triangles.size(); ++triangle)
    for (const std::uint32_t v : flank.triangles[triangle]) {
      const Vec3& q = flank.vertices[v];
      const Vec3 along = Vec3(-q.y(), q.x(), lead_m / (2 * std::numbers::pi)).normalized();
      EXPECT_LE(std::abs(distance.smoothNormal(triangle, q).dot(along)), tol);
    }
}

}  // namespace
}  // namespace vps::test
