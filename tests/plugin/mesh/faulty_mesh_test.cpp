// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps of faulty meshes, compared with the closed mesh from which the faulty one was made.
// The file has more than 400 lines because each kind of fault is made beside its test.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>

#include "support/analytic.h"
#include "support/lathe.h"
#include "vps/mesh_distance.h"
#include "vps/mesh_repair.h"
#include "vps/query.h"
#include "vps/solid.h"
#include "vps/voxmap.h"
#include "vps/winding_number.h"

namespace vps::test {
namespace {

constexpr double kFaultyVoxel_m = 0.5e-3;
constexpr VoxMapSettings kFaultySettings = {kFaultyVoxel_m, 4};

/// The signed distance to the true surface, or -1 and 1 where a formula gives only the sign.
using Truth = std::function<double(const Vec3&)>;
using Skip = std::function<bool(const Vec3&)>;

/// Counts grid nodes around a map, up to 8 voxels away, with a wrong sign; `skip` excludes nodes.
std::size_t wrongSigns(const VoxMap& map, const Truth& distance_m, const Skip& skip = {}) {
  const double h = map.voxel_m();
  // Half a quantum of the stored distances, and the rounding of the node's coordinates. A node that is nearer
  // to the surface is stored as 0, which has no side; its value must then differ from the truth by at most
  // this.
  const double rounding_m = 0.51 * map.quantum_m();
  const Eigen::Array3i low = (map.bounds().min / h).array().floor().cast<int>() - 8;
  const Eigen::Array3i high = (map.bounds().max / h).array().ceil().cast<int>() + 8;
  std::size_t wrong = 0;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) {
        const Vec3 p = h * Vec3(x, y, z);
        if (skip && skip(p)) continue;
        const double got_m = map.distance(p), true_m = distance_m(p);
        wrong += std::abs(true_m) > rounding_m ? (got_m < 0) != (true_m < 0)
                                               : std::abs(got_m - true_m) > rounding_m;
      }
  return wrong;
}

Truth distanceTo(const Mesh& closed) {
  return [truth = std::make_shared<MeshDistance>(closed)](const Vec3& p) { return truth->signedDistance(p); };
}

MeshReport reportOf(const Mesh& mesh, VoxMap* map = nullptr) {
  MeshReport report;
  const VoxMap built = buildVoxMap(mesh, kFaultySettings, "", {}, &report);
  if (map != nullptr) *map = built;
  return report;
}

/// A rotated tube: no face is aligned with the grid.
Mesh tube() {
  return transformed(makeTube(0.01, 0.006, 0.012, 48), RandomPoints(2).pose(0.01));
}

/// A plate of 20 x 20 x 6 mm whose upper face has a square hole of the given size in its middle, and the same
/// plate without the hole; both moved by X.
Mesh plateWithHole(double hole_m, bool is_closed, const Pose& X) {
  const double a = 0.01, b = hole_m / 2, z = 0.003;
  Mesh mesh;
  const auto square = [&](double half, double height) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      mesh.vertices.emplace_back(sx * half, sy * half, height);
    return first;
  };
  const auto join = [&](std::uint32_t outer, std::uint32_t inner) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      mesh.triangles.push_back({outer + i, outer + j, inner + j});
      mesh.triangles.push_back({outer + i, inner + j, inner + i});
    }
  };
  const std::uint32_t bottom = square(a, -z), top = square(a, z), rim = square(b, z);
  join(bottom, top);
  join(top, rim);
  mesh.triangles.push_back({bottom, bottom + 2, bottom + 1});
  mesh.triangles.push_back({bottom, bottom + 3, bottom + 2});
  if (is_closed) {
    mesh.triangles.push_back({rim, rim + 1, rim + 2});
    mesh.triangles.push_back({rim, rim + 2, rim + 3});
  }
  return transformed(mesh, X);
}

TEST(FaultyMesh, APlaneHoleOfAnySizeLeavesEverySignRight) {
  // The missing part is plane, so it covers less than half of the solid angle from either side: the winding
  // number w stays above 0.5 inside and below 0.5 outside, up to the hole. Only the error of the series (0.02
  // with a margin) blurs the hole's own plane: over a hole of size a the slope of w is at least 1 / pi a in
  // its middle and larger at its rim.
  for (const double hole_voxels : {0.1, 0.5, 1.0, 3.0, 10.0, 30.0}) {
    const double hole_m = hole_voxels * kFaultyVoxel_m;
    const Pose X = RandomPoints(3).pose(0.01), X_inverse = X.inverse();
    const auto isInHole = [&](const Vec3& p) {
      const Vec3 q = X_inverse * p;
      return std::abs(q.z() - 0.003) < 0.02 * std::numbers::pi * hole_m;
    };
    VoxMap map;
    const MeshReport report = reportOf(plateWithHole(hole_m, false, X), &map);
    EXPECT_EQ(wrongSigns(map, distanceTo(plateWithHole(hole_m, true, X)), isInHole), 0u) << hole_voxels;
    EXPECT_EQ(report.open_edges, 4u);
    EXPECT_EQ(report.holes, 1u);
    EXPECT_TRUE(report.signed_by_winding);
    // The sign is uncertain at nodes from which the hole covers more than pi, a quarter of the full solid
    // angle: nodes nearer than the hole's size.
    EXPECT_EQ(report.certain_share < 1, hole_voxels >= 3) << hole_voxels;
    EXPECT_GT(report.certain_share, 0.8);
  }
}

TEST(FaultyMesh, AHoleInARoundFaceIsClosedWithinItsSagitta) {
  const Mesh sphere = makeSphere(0.01, 4);
  for (const double hole_m : {0.001, 0.004, 0.01}) {
    Mesh open = sphere;
    std::erase_if(open.triangles, [&](const auto& t) {
      return (sphere.vertices[t[0]] - Vec3(0, 0, 0.01)).norm() < hole_m / 2;
    });
    // The missing cap reaches one facet farther; its height is r^2 / 2R.
    const double rim_m = hole_m / 2 + 0.8e-3, sagitta_m = rim_m * rim_m / (2 * 0.01);
    const auto isNearHole = [&](const Vec3& p) {
      return (p - Vec3(0, 0, 0.01)).norm() < rim_m + sagitta_m && std::abs(p.norm() - 0.01) < 1.5 * sagitta_m;
    };
    VoxMap map;
    reportOf(open, &map);
    EXPECT_EQ(wrongSigns(map, distanceTo(sphere), isNearHole), 0u) << hole_m;
  }
}

TEST(FaultyMesh, FlippedFacetsAreTurned) {
  Mesh flipped = tube();
  std::size_t count = 0;
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 50, ++count)
    std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
  VoxMap map;
  const MeshReport report = reportOf(flipped, &map);
  EXPECT_EQ(report.flipped_facets, count);
  EXPECT_FALSE(report.signed_by_winding);  // the mesh has no faults again
  EXPECT_EQ(report.certain_share, 1);
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
}

TEST(FaultyMesh, AShellThatFacesInIsTurnedAndACavityIsNot) {
  const Pose X = RandomPoints(9).pose(0.01);
  const Mesh sphere = transformed(makeSphere(0.008, 3), X);
  Mesh ball = sphere;
  for (auto& t : ball.triangles) std::swap(t[0], t[1]);
  VoxMap map;
  EXPECT_EQ(reportOf(ball, &map).turned_shells, 1u);
  EXPECT_EQ(wrongSigns(map, distanceTo(sphere)), 0u);

  const Mesh outer = transformed(makeSphere(0.01, 3), X);
  Mesh hollow = outer;
  append(hollow, ball);
  const auto truth = [to_outer = distanceTo(outer), to_cavity = distanceTo(sphere)](const Vec3& p) {
    return std::max(to_outer(p), -to_cavity(p));
  };
  const MeshReport report = reportOf(hollow, &map);
  EXPECT_EQ(report.turned_shells, 0u);
  EXPECT_EQ(report.overlapping_shells, 0u);
  EXPECT_EQ(report.certain_share, 1);
  EXPECT_EQ(wrongSigns(map, truth), 0u);
  for (auto& t : hollow.triangles) std::swap(t[0], t[1]);  // all shells face in
  EXPECT_EQ(reportOf(hollow, &map).turned_shells, 2u);
  EXPECT_EQ(wrongSigns(map, truth), 0u);
}

TEST(FaultyMesh, OverlappingShellsAreTheirUnion) {
  const Mesh a = tube(),
             b = transformed(makeBox({0.03, 0.006, 0.005}),
                             Pose(Mat3::Identity(), bounds(a).center()) * RandomPoints(5).pose(1e-3));
  Mesh both = a;
  append(both, b);
  VoxMap map;
  const MeshReport report = reportOf(both, &map);
  EXPECT_EQ(report.shells, 2u);
  EXPECT_TRUE(report.signed_by_winding);
  EXPECT_EQ(report.certain_share, 1);
  EXPECT_EQ(report.united_shells, 2u);
  // No facet within the other shell is left: in such places the union is at least as deep as each of the two
  // shells.
  const auto truth = [to_a = distanceTo(a), to_b = distanceTo(b)](const Vec3& p) {
    return std::min(to_a(p), to_b(p));
  };
  EXPECT_EQ(wrongSigns(map, truth), 0u);
}

// The middle and the corners of each facet of the floor lie in a wall, and the area between them does not.
TEST(FaultyMesh, AFloorUnderFourWallsStaysWhereItIsFree) {
  const auto block = [](const Vec3& min, const Vec3& max) {
    return transformed(makeBox(max - min), Pose::translation(0.5 * (min + max)));
  };
  Mesh box = block({-0.03, -0.02, -0.005}, {0.03, 0.02, 0.0001});
  append(box, block({-0.03, -0.01, 0}, {-0.01, 0.01, 0.03}));
  append(box, block({0.01, -0.01, 0}, {0.03, 0.01, 0.03}));
  append(box, block({-0.03, -0.02, 0}, {0.03, -0.01005, 0.04}));
  append(box, block({-0.03, 0.01005, 0}, {0.03, 0.02, 0.04}));
  const Solid solid(box);
  EXPECT_NEAR(solid.signedDistance({-0.002, 0.003, 0.0003}), 0.0002, 1e-9);  // above the floor
  EXPECT_NEAR(solid.signedDistance({-0.002, 0.003, 0}), -0.0001, 1e-9);      // in it
  EXPECT_LT(solid.signedDistance({-0.02, 0, 0.01}), 0);
}

TEST(FaultyMesh, AShellWithinAnotherIsLeftOut) {
  Mesh nested = makeSphere(0.01, 3);
  append(nested, makeSphere(0.006, 3));
  VoxMap map;
  const MeshReport report = reportOf(nested, &map);
  EXPECT_EQ(report.internal_facets, 1280u);
  EXPECT_EQ(report.overlapping_shells, 1u);
  EXPECT_EQ(wrongSigns(map, distanceTo(makeSphere(0.01, 3))), 0u);
  EXPECT_EQ(map.distance({0.006, 0, 0}), -map.band_m());  // 4 mm deep
}

TEST(FaultyMesh, AMeshThatCrossesItselfIsItsUnion) {
  // One shell: a hose bent into itself, rings of 8 vertices around a curve.
  Mesh hose;
  constexpr int kRings = 40, kSegments = 12;
  for (int i = 0; i < kRings; ++i) {
    const double s = 1.15 * 2 * std::numbers::pi * i / kRings;  // overlaps its beginning
    const Vec3 radial(std::cos(s), std::sin(s), 0), middle = 0.012 * radial + Vec3(0, 0, 1e-4 * i);
    for (int k = 0; k < kSegments; ++k) {
      const double turn = 2 * std::numbers::pi * k / kSegments;
      hose.vertices.push_back(middle + 0.004 * (std::cos(turn) * radial + std::sin(turn) * Vec3::UnitZ()));
    }
  }
  const auto at = [](int ring, int k) {
    return static_cast<std::uint32_t>(ring * kSegments + k % kSegments);
  };
  for (int i = 0; i + 1 < kRings; ++i)
    for (int k = 0; k < kSegments; ++k) {
      hose.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      hose.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  for (int k = 1; k + 1 < kSegments; ++k) {
    hose.triangles.push_back({at(0, 0), at(0, k + 1), at(0, k)});
    hose.triangles.push_back({at(kRings - 1, 0), at(kRings - 1, k), at(kRings - 1, k + 1)});
  }
  hose = transformed(hose, RandomPoints(4).pose(0.01));
  if (massProperties(hose).volume_m3 < 0)
    for (auto& t : hose.triangles) std::swap(t[0], t[1]);
  ASSERT_TRUE(checkMesh(hose).isClosed());
  VoxMap map;
  const MeshReport report = reportOf(hose, &map);
  EXPECT_TRUE(report.signed_by_winding);
  // Truth: crossings of a ray, each counted with its sign.
  const auto side = [&](const Vec3& p) {
    int windings = 0;
    const Vec3 way = Vec3(0.3, 0.2, 0.93).normalized();
    for (const auto& t : hose.triangles) {
      const Vec3 a = hose.vertices[t[0]] - p, b = hose.vertices[t[1]] - p, c = hose.vertices[t[2]] - p;
      const double u = way.dot(a.cross(b)), v = way.dot(b.cross(c)), w = way.dot(c.cross(a));
      if (((u < 0) != (v < 0)) || ((v < 0) != (w < 0))) continue;
      if (a.dot((b - a).cross(c - a)) * (u + v + w) <= 0) continue;  // behind
      windings += u + v + w > 0 ? 1 : -1;
    }
    return windings > 0 ? -1.0 : 1.0;
  };
  EXPECT_EQ(wrongSigns(map, side), 0u);
}

TEST(FaultyMesh, AnInternalWallIsRemovedFromTheSurface) {
  // A cuboid in two halves that share the four corners of a wall: once with one wall, and once with two walls
  // back to back.
  Mesh closed;
  for (const double x : {-0.01, 0.0, 0.01})
    for (const auto& [y, z] : {std::pair{-0.004, -0.004}, {0.004, -0.004}, {0.004, 0.004}, {-0.004, 0.004}})
      closed.vertices.emplace_back(x, y, z);
  const auto quad = [](Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (const std::uint32_t ring : {0u, 4u})
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = ring + i, b = ring + (i + 1) % 4;
      quad(closed, a, a + 4, b + 4, b);
    }
  quad(closed, 0, 1, 2, 3);
  quad(closed, 8, 11, 10, 9);
  if (massProperties(closed).volume_m3 < 0)
    for (auto& t : closed.triangles) std::swap(t[1], t[2]);
  closed = transformed(closed, RandomPoints(6).pose(0.01));
  ASSERT_TRUE(checkMesh(closed).isClosed());
  Mesh one = closed, two = closed;
  quad(one, 4, 5, 6, 7);
  two.triangles.insert(two.triangles.end(), {{4, 5, 6}, {4, 6, 7}, {6, 5, 4}, {7, 6, 4}});
  for (const Mesh& mesh : {one, two}) {
    VoxMap map;
    const MeshReport report = reportOf(mesh, &map);
    EXPECT_EQ(report.non_manifold_edges, mesh.triangles.size() == one.triangles.size() ? 4u : 5u);
    EXPECT_EQ(wrongSigns(map, distanceTo(closed)), 0u);
    EXPECT_EQ(map.distance(closed.vertices[4] * 0.5 + closed.vertices[6] * 0.5), -map.band_m());
  }
}

TEST(FaultyMesh, DuplicateAndDegenerateTrianglesChangeNothing) {
  Mesh mesh = tube();
  for (std::size_t i = 0; i < 60; i += 3) mesh.triangles.push_back(mesh.triangles[i]);
  VoxMap map;
  EXPECT_EQ(reportOf(mesh, &map).duplicate_triangles, 20u);
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
  // A side of a facet gets a corner in its middle, and a sliver fills the gap.
  mesh = tube();
  const auto [a, b, c] = mesh.triangles[7];
  mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.triangles[7] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
  mesh.triangles.push_back({a, b, middle});
  ASSERT_TRUE(checkMesh(mesh).isClosed());
  EXPECT_EQ(reportOf(mesh, &map).degenerate_triangles, 1u);
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
}

TEST(FaultyMesh, ASurfaceExportedForBothSidesIsASolid) {
  Mesh both = tube();
  for (const auto& t : tube().triangles) both.triangles.push_back({t[0], t[2], t[1]});
  VoxMap map;
  EXPECT_EQ(reportOf(both, &map).duplicate_triangles, tube().triangles.size());
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
}

TEST(FaultyMesh, TJunctionsAreNotHoles) {
  Mesh mesh = tube();
  for (const std::size_t i : {7u, 20u, 50u}) {  // a facet is cut and its neighbour is not
    const auto [a, b, c] = mesh.triangles[i];
    mesh.vertices.push_back(0.4 * mesh.vertices[a] + 0.6 * mesh.vertices[b]);
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    mesh.triangles[i] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
  }
  VoxMap map;
  const MeshReport report = reportOf(mesh, &map);
  EXPECT_EQ(report.t_junctions, 3u);
  EXPECT_EQ(report.open_edges, 9u);
  EXPECT_EQ(report.certain_share, 1);
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
}

/// A box of six faces, each with corners of its own, up to hair_m apart; each face has 2 x 8 x 8 triangles.
Mesh partedBox(const Mesh& box, RandomPoints& random, double hair_m, bool has_flipped) {
  Mesh faces;
  for (std::size_t i = 0; i < 6; ++i) {
    Mesh face;
    const auto &t = box.triangles[2 * i], &u = box.triangles[2 * i + 1];
    const Vec3 a = box.vertices[t[0]], ab = box.vertices[t[1]] - a, ad = box.vertices[u[2]] - a;
    const Vec3 hair = random.inBox(Vec3::Constant(hair_m));
    for (int x = 0; x <= 8; ++x)
      for (int y = 0; y <= 8; ++y) face.vertices.push_back(a + hair + x / 8.0 * ab + y / 8.0 * ad);
    for (std::uint32_t x = 0; x < 8; ++x)
      for (std::uint32_t y = 0; y < 8; ++y) {
        const std::uint32_t v = 9 * x + y;
        face.triangles.push_back({v, v + 9, v + 10});
        face.triangles.push_back({v, v + 10, v + 1});
      }
    if (has_flipped && i == 3)
      for (auto& triangle : face.triangles) std::swap(triangle[0], triangle[1]);
    append(faces, face);
  }
  return faces;
}

TEST(FaultyMesh, OneShellPerFaceIsASolidEvenIfSomeShellsFaceIn) {
  RandomPoints random(7);
  const Mesh box = transformed(makeBox({0.016, 0.012, 0.01}), random.pose(0.01));
  constexpr double kHair_m = 1e-5;
  for (const bool has_flipped : {false, true}) {
    VoxMap map;
    const MeshReport report = reportOf(partedBox(box, random, kHair_m, has_flipped), &map);
    EXPECT_EQ(report.shells, 6u);
    EXPECT_EQ(report.turned_shells, has_flipped ? 1u : 0u);
    EXPECT_EQ(report.joined_corners, 0u);
    // Cracks of 2 sqrt(3) hairs: a node that near to a face may have either sign.
    const MeshDistance truth(box);
    EXPECT_EQ(wrongSigns(map, distanceTo(box),
                         [&](const Vec3& p) { return std::abs(truth.signedDistance(p)) < 4 * kHair_m; }),
              0u);
  }
}

TEST(FaultyMesh, NarrowCracksAreClosed) {
  RandomPoints random(7);
  const Mesh box = transformed(makeBox({0.016, 0.012, 0.01}), random.pose(0.01));
  constexpr double kHair_m = 1e-7;
  for (const bool has_flipped : {false, true}) {
    const Solid solid(partedBox(box, random, kHair_m, has_flipped));
    const MeshReport& report = solid.report();
    EXPECT_TRUE(checkMesh(solid.mesh()).isClosed());
    EXPECT_EQ(report.open_edges, 0u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_EQ(report.flipped_facets, has_flipped ? 128u : 0u);
    // Corners that lie apart: seven of two faces on each of twelve edges, and eight of three faces.
    EXPECT_EQ(report.joined_corners, 12u * 7 + 8 * 2);
    EXPECT_GT(report.joined_m, kHair_m / 10);
    EXPECT_LE(report.joined_m, 2 * std::sqrt(3) * kHair_m);
    EXPECT_FALSE(report.signed_by_winding);
    // Each face has moved by a hair, and a corner by up to two hairs.
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random.inBox(Vec3::Constant(0.02));
      EXPECT_NEAR(solid.signedDistance(p), MeshDistance(box).signedDistance(p), 4 * kHair_m);
    }
  }
}

/// A pipe of two open walls, r = 10 and 9 mm, both facing out. The pipe's inner wall is flipped, so that
/// winding numbers are near 2 within, and still above 0.5 some millimetres in front of its mouths.
Mesh pipeWithAFlippedWall() {
  Mesh pipe;
  for (const double radius_m : {0.01, 0.009}) {
    constexpr std::uint32_t kSides = 64;
    Mesh wall;
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle_rad = 2 * std::numbers::pi * i / kSides;
      const double x = radius_m * std::cos(angle_rad), y = radius_m * std::sin(angle_rad);
      wall.vertices.insert(wall.vertices.end(), {Vec3(x, y, -0.02), Vec3(x, y, 0.02)});
      const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
      wall.triangles.insert(wall.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
    append(pipe, wall);
  }
  return pipe;
}

/// Tests readings at a band or more from the surface's box, up to beyond the directory. Normals read two
/// voxels away.
void expectOutsideBeyondTheBox(const VoxMap& map, double coarsest_m) {
  RandomPoints random(71);
  const Box& box = map.bounds();
  for (int n = 0; n < 50000; ++n) {
    const Vec3 p = box.center() + random.inBox(0.5 * box.size() + Vec3::Constant(0.01));
    const Vec3 way = (box.min - p).cwiseMax(p - box.max);
    if (way.maxCoeff() < map.band_m() + 2 * coarsest_m) continue;
    ASSERT_EQ(map.distance(p), map.band_m()) << p.transpose();
    ASSERT_TRUE(map.normal(p, Gradient::Continuous).isZero()) << p.transpose();
  }
}

/// Compares culled and coherent answers with the exhaustive one, around the mouth of a part along z.
void expectSameAnswers(const VoxMap& map, const PointShell& shell) {
  QueryMemory memory(map, shell);
  RandomPoints random(72);
  std::size_t touching = 0;
  for (int n = 0; n < 60; ++n) {
    const Pose X_MP{random.pose(0).R, Vec3(0, 0, 0.021) + random.inBox({0.012, 0.012, 0.006})};
    QueryOptions options;
    TouchSummary culled, coherent, all;
    queryWrench(map, shell, X_MP, options, 1e11, Vec3::Zero(), culled);
    queryWrench(map, shell, X_MP, options, 1e11, Vec3::Zero(), coherent, &memory);
    options.is_exhaustive = true;
    queryWrench(map, shell, X_MP, options, 1e11, Vec3::Zero(), all);
    for (const TouchSummary* sum : {&culled, &coherent}) {
      ASSERT_EQ(sum->count, all.count);
      ASSERT_EQ(sum->F_O_M.f, all.F_O_M.f);
      ASSERT_EQ(sum->F_O_M.tau, all.F_O_M.tau);
      ASSERT_EQ(sum->max_depth_m, all.max_depth_m);
    }
    touching += all.count;
  }
  EXPECT_GT(touching, 1000u);
}

TEST(FaultyMesh, BeyondTheBandEveryPointIsOutsideForAnyWindingNumber) {
  const Mesh pipe = pipeWithAFlippedWall();
  ASSERT_GT(WindingNumber(pipe).at({0, 0, 0.0235}).w, 0.5);  // beyond a directory with voxels of 0.25 mm
  const PointShell shell = buildPointShell(makeSphere(0.003, 4), {0.2e-3, 0.35});
  const VoxMap map = buildVoxMap(pipe, {0.25e-3, 4});
  expectOutsideBeyondTheBox(map, 0.25e-3);
  expectSameAnswers(map, shell);
}

TEST(FaultyMesh, AFreeSheetHasNoInside) {
  Mesh mesh = tube();
  const Vec3 o = bounds(mesh).center() + Vec3(0.02, 0, 0);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {o, o + Vec3(0.01, 0, 0.001), o + Vec3(0, 0.01, 0)});
  mesh.triangles.push_back({first, first + 1, first + 2});
  VoxMap map;
  const MeshReport report = reportOf(mesh, &map);
  EXPECT_EQ(report.sheet_facets, 1u);
  EXPECT_EQ(report.certain_share, 1);
  EXPECT_EQ(wrongSigns(map, distanceTo(tube())), 0u);
  const Vec3 on_sheet = o + Vec3(0.003, 0.003, 0.0003);
  EXPECT_LT(map.distance(on_sheet), kFaultyVoxel_m);  // the sheet is part of the surface
}

TEST(FaultyMesh, ManyThreadsGiveTheBitsOfOneThread) {
  Mesh mesh = tube();
  mesh.triangles.erase(mesh.triangles.begin() + 10, mesh.triangles.begin() + 30);
  append(mesh, transformed(makeBox({0.02, 0.004, 0.004}), Pose(Mat3::Identity(), bounds(mesh).center())));
  MeshReport report_many, report_one;
  const VoxMap many = buildVoxMap(mesh, kFaultySettings, "", {}, &report_many);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const VoxMap one = buildVoxMap(mesh, kFaultySettings, "", {}, &report_one);
  EXPECT_EQ(describe(report_many), describe(report_one));
  EXPECT_EQ(report_many.certain_share, report_one.certain_share);
  RandomPoints random(8);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = many.bounds().center() + random.inBox(many.bounds().size());
    ASSERT_EQ(many.distance(p), one.distance(p));
  }
}

/// A cube of tetrahedra, `along` of them on each axis, a tetrahedron's size apart.
Mesh tetrahedra(int along) {
  Mesh mesh;
  for (int n = 0; n < along * along * along; ++n) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 o = 2e-3 * Vec3(n / (along * along), n / along % along, n % along);
    mesh.vertices.insert(mesh.vertices.end(),
                         {o, o + Vec3(1e-3, 0, 0), o + Vec3(0, 1e-3, 0), o + Vec3(0, 0, 1e-3)});
    for (const auto& [a, b, c] : {std::array{0u, 2u, 1u}, {0u, 1u, 3u}, {1u, 2u, 3u}, {2u, 0u, 3u}})
      mesh.triangles.push_back({first + a, first + b, first + c});
  }
  return mesh;
}

TEST(FaultyMesh, ManySeparateShellsAreSoundAndAreTurned) {
  // Comparing all pairs would take minutes for half a million shells.
  const Mesh apart = tetrahedra(31);
  const RepairedMesh sound = repairMesh(apart);
  EXPECT_TRUE(sound.is_sound);
  EXPECT_EQ(sound.report.shells, 29791u);
  EXPECT_EQ(sound.surface.triangles, apart.triangles);
  EXPECT_EQ(sound.solid.triangles, apart.triangles);
  Mesh facing_in = apart;
  for (auto& t : facing_in.triangles) std::swap(t[1], t[2]);
  const RepairedMesh turned = repairMesh(facing_in);
  EXPECT_TRUE(turned.is_sound);
  EXPECT_EQ(turned.report.turned_shells, 29791u);
  EXPECT_EQ(turned.surface.triangles, apart.triangles);
}

TEST(FaultyMesh, TwoOverlappingShellsAmongManyAreFound) {
  const Mesh apart = tetrahedra(12);
  for (const std::uint32_t shell : {1u, 700u, 1727u}) {
    // In one mesh a shell reaches into its neighbour; in the other mesh it faces in and lies within its
    // neighbour, as a cavity.
    Mesh overlapping = apart, hollow = apart;
    for (std::uint32_t v = 4 * shell; v < 4 * shell + 4; ++v) {
      overlapping.vertices[v].z() -= 1.5e-3;
      hollow.vertices[v] = apart.vertices[4 * shell - 4] + Vec3::Constant(0.1e-3) +
                           0.2 * (apart.vertices[v] - apart.vertices[4 * shell]);
    }
    for (std::uint32_t i = 4 * shell; i < 4 * shell + 4; ++i)
      std::swap(hollow.triangles[i][1], hollow.triangles[i][2]);
    EXPECT_FALSE(repairMesh(overlapping).is_sound) << shell;
    const RepairedMesh cavity = repairMesh(hollow);
    EXPECT_FALSE(cavity.is_sound) << shell;
    EXPECT_EQ(cavity.report.turned_shells, 0u) << shell;
    EXPECT_EQ(cavity.surface.triangles, hollow.triangles) << shell;
  }
}

TEST(FaultyMesh, TheReportReadsAsASentence) {
  MeshReport report;
  report.shells = 12;
  report.open_edges = 34;
  report.flipped_facets = 1;
  report.certain_share = 0.99876;
  EXPECT_EQ(describe(report),
            "12 shells, 34 open edges, 1 flipped facet turned; the sign of the distance is certain at "
            "99.87 % of the nodes");
}

}  // namespace
}  // namespace vps::test
