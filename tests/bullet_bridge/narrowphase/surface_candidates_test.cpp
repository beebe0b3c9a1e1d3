// SPDX-License-Identifier: BSD-3-Clause
// The search with bounds finds the same points near another part's surface as testing each point.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bullet_bridge/native_shapes.h"
#include "narrowphase/candidates/contact_candidate.h"
#include "native_shapes/native_shape.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::cube;
using test::Ground;
using test::slabHull;
using test::slabMesh;

Pose randomPose(std::mt19937& random, double reach_m) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return test::drawnVector(any, random); };
  const Vec3 turn = 3 * vector();
  return {rotationFromVector(turn), reach_m * vector()};
}

TEST(SurfaceCandidates, AreThoseOfEveryPointMeasuredAlone) {
  // A ring around a peg's place: points inside, outside, in the hole, and far away.
  static const Built ring = test::build(makeTube(0.012, 0.006, 0.01, 48), 7850, 0.5e-3, 1e-3);
  ShapeModels without_map = ring.shape->models();
  without_map.map = nullptr;
  const Shape surface(without_map);
  const PointShell& shell = *cube().shape->models().shell;
  std::mt19937 random(7);
  std::size_t found = 0, tested = 0;
  for (int i = 0; i < 60; ++i) {
    const SideView side{cube().shape.get(), randomPose(random, 0.012), 0};
    const SideView other{&surface, randomPose(random, 0.002), 1};
    for (const double cutoff_m : {0.0, 0.1e-3, 2e-3}) {
      std::vector<Candidate> got;
      findSurfaceCandidates(side, other, cutoff_m, {}, got, tested);
      std::vector<std::pair<std::uint32_t, double>> expected;
      const Pose X_NM = other.X_WM.inverse() * side.X_WM;
      for (std::uint32_t id = 0; id < shell.size(); ++id) {
        const double distance_m = ring.exact->signedDistance(X_NM * shell.points[id]);
        if (distance_m <= cutoff_m) expected.emplace_back(id, distance_m);
      }
      ASSERT_EQ(got.size(), expected.size()) << i;
      for (std::size_t k = 0; k < got.size(); ++k) {
        ASSERT_EQ(got[k].id, expected[k].first);
        ASSERT_EQ(got[k].distance_m, expected[k].second);
      }
      found += got.size();
    }
  }
  EXPECT_GT(found, 1000u);
  EXPECT_LT(tested, 60 * 3 * shell.size()) << "the bounds leave points out";
}

// Representative points are built in O(points), and few of hundreds of pairs need them.
TEST(MapCandidates, MakeRepresentativePointsOnlyWhereManyAreNear) {
  static const Built plate = test::build(makeBox(Vec3(0.02, 0.02, 0.004)), 7850, 0.25e-3, 0.25e-3);
  const ShapeModels& models = plate.shape->models();
  Settings settings;
  settings.contact_limit = 32;
  const std::size_t many = smallQueryLimit(settings);
  QueryState state(*models.map, *models.shell);
  std::size_t tested = 0, near = 0;
  for (const double height_m : {0.1, 0.0041, 0.004}) {  // far apart, side by side, face on face
    const SideView side{plate.shape.get(), Pose::translation(Vec3(0, 0, height_m)), 0};
    const SideView other{plate.shape.get(), Pose(), 1};
    for (const double shift_m : {0.0199, 0.0}) {
      SideView shifted = side;
      shifted.X_WM.p.x() = shift_m;
      std::vector<Candidate> all, chosen;
      findMapCandidates(shifted, other, 20e-6, settings, {}, all, tested);
      findMapCandidates(shifted, other, 20e-6, settings, {&state, {}, {}}, chosen, tested);
      near = std::max(near, all.size());
      EXPECT_EQ(state.leading.has_value(), near > many) << height_m << ' ' << shift_m;
      if (all.size() <= many)
        EXPECT_EQ(chosen.size(), all.size());
      else
        EXPECT_LT(chosen.size(), all.size() / 4);
    }
  }
  EXPECT_GT(near, many) << "the last pose is dense enough for this test";
}

TEST(ContentHash, ChangesWithAnyCornerOrIndex) {
  Ground ground;
  btTriangleMesh triangles;
  const Mesh cube_mesh = makeBox(Vec3::Constant(0.01));
  for (const auto& t : cube_mesh.triangles)
    triangles.addTriangle(toBt(cube_mesh.vertices[t[0]]), toBt(cube_mesh.vertices[t[1]]),
                          toBt(cube_mesh.vertices[t[2]]), true);
  btBvhTriangleMeshShape mesh(&triangles, true);
  const std::uint64_t first = contentHash(mesh);
  EXPECT_EQ(contentHash(mesh), first);
  unsigned char *vertices = nullptr, *indices = nullptr;
  int vertex_count = 0, vertex_stride = 0, index_stride = 0, face_count = 0;
  PHY_ScalarType vertex_type = PHY_FLOAT, index_type = PHY_INTEGER;
  triangles.getLockedVertexIndexBase(&vertices, vertex_count, vertex_type, vertex_stride, &indices,
                                     index_stride, face_count, index_type);
  for (int v = 0; v < vertex_count; ++v)
    for (int k = 0; k < 3; ++k) {
      btScalar& coordinate = reinterpret_cast<btScalar*>(vertices + std::ptrdiff_t(v) * vertex_stride)[k];
      const btScalar before = coordinate;
      coordinate = btScalar(0.999) * before;
      EXPECT_NE(contentHash(mesh), first) << v << ' ' << k;
      coordinate = before;
    }
  for (int t = 0; t < face_count; ++t) {
    int* corners = reinterpret_cast<int*>(indices + std::ptrdiff_t(t) * index_stride);
    std::swap(corners[1], corners[2]);
    EXPECT_NE(contentHash(mesh), first) << t;
    std::swap(corners[1], corners[2]);
  }
  EXPECT_EQ(contentHash(mesh), first);
  btConvexHullShape& hull = slabHull(ground);
  const std::uint64_t of_hull = contentHash(hull);
  for (int i = 0; i < hull.getNumPoints(); ++i) {
    hull.getUnscaledPoints()[i] *= btScalar(1.001);
    EXPECT_NE(contentHash(hull), of_hull) << i;
    hull.getUnscaledPoints()[i] /= btScalar(1.001);
  }
}

}  // namespace
}  // namespace vps::bullet
