// SPDX-License-Identifier: BSD-3-Clause
#include "vps/representative_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include "support/no_alloc.h"
#include "support/random_draw.h"

namespace vps {
namespace {

constexpr double kRadius_m = 10e-3, kAir_m = 20e-6, kSpacing_m = 0.15e-3, kTile_m = 12 * kSpacing_m;
constexpr double kVoxel_m = 0.25e-3;

// A peg in its bore with 20 um of clearance all around: every point of its side is near.
struct Fit {
  VoxMap map = buildVoxMap(makeTube(12e-3, kRadius_m + kAir_m, 20e-3, 1024), {kVoxel_m, 4});
  PointShell shell = buildPointShell(makeCylinder(kRadius_m, 5e-3, 1024), {kSpacing_m, 0.35});
  RepresentativePoints leading{shell, kTile_m};
  RepresentativePoints::Request request;
  Pose X_MP{rotationFromVector({1e-4, -2e-4, 0.3}), {3e-6, -2e-6, 1e-3}};

  Fit() {
    request.options.cutoff_m = 40e-6;
    request.step_M = {{1e-4, 2e-4, 2e-3}, {20e-6, 5e-6, 30e-6}};
  }
  std::vector<Contact> all(const Pose& pose) const {
    ContactSet set(shell.size());
    queryContacts(map, shell, pose, request.options, set);
    return set.contacts;
  }
  [[nodiscard]] bool isAtRim(std::uint32_t id) const {
    return std::abs(std::abs(shell.points[id].z()) - 0.5 * 5e-3) < 1e-9;
  }
  std::vector<Contact> lead(const Pose& pose, QueryMemory* memory = nullptr) {
    ContactSet set(shell.size());
    EXPECT_EQ(leading.find(map, pose, request, set, memory).status, Status::Ok);
    return set.contacts;
  }
};

Fit& fit() {
  static Fit fit;
  return fit;
}

bool isSame(const Contact& a, const Contact& b) {
  return a.id == b.id && a.p_M == b.p_M && a.n_M == b.n_M && a.distance_m == b.distance_m &&
         a.area_m2 == b.area_m2 && a.owner == b.owner;
}

bool isSame(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Contact& x, const Contact& y) { return isSame(x, y); });
}

double gapAfter(const Contact& c, const Twist& step_M) {
  return c.distance_m + c.n_M.dot(step_M.v + step_M.w.cross(c.p_M));
}

TEST(RepresentativePoints, EachEqualsTheQuerysContactAndTheyAreFew) {
  const std::vector<Contact> all = fit().all(fit().X_MP), few = fit().lead(fit().X_MP);
  ASSERT_TRUE(fit().leading.reducesContacts());
  ASSERT_GT(all.size(), 10000u);
  EXPECT_LT(few.size(), all.size() / 10);
  auto at = all.begin();
  for (const Contact& c : few) {  // in ascending order, as the contacts of a query
    at = std::find_if(at, all.end(), [&](const Contact& other) { return other.id == c.id; });
    ASSERT_NE(at, all.end()) << c.id;
    EXPECT_TRUE(isSame(c, *at)) << c.id;
  }
}

// A leaf of sixteen points counts as a whole, so the border of the near surface is accurate to a leaf's size,
// four spacings. The near surface is the part of the peg's side within the bore's mouth: in this test, all of
// it.
TEST(RepresentativePoints, TheirSurfacesHaveTheMomentsOfTheNearPoints) {
  const std::vector<Contact> few = fit().lead(fit().X_MP);
  const auto surfaces = fit().leading.surfaces();
  ASSERT_EQ(surfaces.size(), few.size());
  const auto add = [](Mat3& second, Vec3& first, double& area_m2, double part_m2, const Vec3& at) {
    area_m2 += part_m2;
    first += part_m2 * at;
    second += part_m2 * at * at.transpose();
  };
  double got_m2 = 0, want_m2 = 0;
  Vec3 got_first = Vec3::Zero(), want_first = Vec3::Zero();
  Mat3 got = Mat3::Zero(), want = Mat3::Zero();
  for (const RepresentativePoints::Surface& s : surfaces) {
    add(got, got_first, got_m2, s.area_m2, s.center);
    got += s.area_m2 * s.spread;
  }
  for (const Contact& c : fit().all(fit().X_MP))
    add(want, want_first, want_m2, c.area_m2, fit().shell.points[c.id]);
  const double border = 4 * kSpacing_m / 5e-3;  // of the height
  EXPECT_NEAR(got_m2 / want_m2, 1, border);
  EXPECT_LE((got_first - want_first).norm(), border * want_m2 * kRadius_m);
  EXPECT_LE((got - want).norm(), border * want.norm());
}

TEST(RepresentativePoints, EachOmittedPointHasANearerOneInItsGroupNowAndAfterTheStep) {
  // By group: the smallest gaps now and after the step.
  std::map<std::uint32_t, std::pair<double, double>> led;
  std::map<std::uint32_t, bool> is_given;
  for (const Contact& c : fit().lead(fit().X_MP)) {
    is_given[c.id] = true;
    auto& [now_m, then_m] = led.try_emplace(fit().leading.groupOf(c.id), 1.0, 1.0).first->second;
    now_m = std::min(now_m, c.distance_m);
    then_m = std::min(then_m, gapAfter(c, fit().request.step_M));
  }
  // Readings are compared at the rounded positions, to 1/16384 voxel, times slopes of at most sqrt 3.
  const double tol_m = 2 * 1.8 * kVoxel_m / 16384 + fit().map.quantum_m();
  // To first order: a facet's normal differs from the linear one by half a facet (2 pi / 1024 / 2) and by the
  // curvature of the group beyond the linear term, (size / 2 radius)^2 / 2; so does the field's. The step is
  // at most 0.04 mm.
  const double lean_rad = 2 * (3.1e-3 + std::pow(kTile_m / (2 * kRadius_m), 2) / 2);
  const double then_tol_m = tol_m + RepresentativePoints::kSame_m + 40e-6 * lean_rad;
  ASSERT_LT(then_tol_m, 0.8e-6);
  std::size_t left_out = 0;
  for (const Contact& c : fit().all(fit().X_MP)) {
    if (is_given.contains(c.id)) continue;
    const std::uint32_t group = fit().leading.groupOf(c.id);
    ASSERT_NE(group, RepresentativePoints::kNone);
    ++left_out;
    ASSERT_TRUE(led.contains(group));
    EXPECT_LE(led[group].first, c.distance_m + tol_m);
    // At a rim the field's normal is that of the other part, which the linear fit does not describe.
    if (!fit().isAtRim(c.id)) {
      EXPECT_LE(led[group].second, gapAfter(c, fit().request.step_M) + then_tol_m);
    }
  }
  EXPECT_GT(left_out, 10000u);
}

TEST(RepresentativePoints, MemoryAndVectorsChangeNoBit) {
  QueryMemory memory(fit().map, fit().shell);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> way(-1, 1);
  Pose X_MP = fit().X_MP;
  for (int i = 0; i < 30; ++i) {
    const Vec3 turn = test::drawnVector(way, random), shift = test::drawnVector(way, random);
    X_MP = Pose(rotationFromVector(1e-4 * turn), 3e-6 * shift) * X_MP;
    const std::vector<Contact> plain = fit().lead(X_MP);
    ASSERT_TRUE(isSame(plain, fit().lead(X_MP, &memory))) << i;
    fit().request.options.simd = Simd::Scalar;
    ASSERT_TRUE(isSame(plain, fit().lead(X_MP))) << i;
    fit().request.options.simd = Simd::Best;
  }
}

TEST(RepresentativePoints, RequiredPointsAreReportedIfTheyAreNear) {
  const std::vector<Contact> all = fit().all(fit().X_MP), few = fit().lead(fit().X_MP);
  const auto has = [](const std::vector<Contact>& list, std::uint32_t id) {
    return std::any_of(list.begin(), list.end(), [&](const Contact& c) { return c.id == id; });
  };
  std::vector<std::uint32_t> always;
  std::size_t near = 0;
  for (std::uint32_t id = 0; id < fit().shell.size(); id += 997)
    if (!has(few, id)) always.push_back(id);
  fit().request.required = always;
  const std::vector<Contact> more = fit().lead(fit().X_MP);
  fit().request.required = {};
  for (const std::uint32_t id : always) {
    EXPECT_EQ(has(more, id), has(all, id)) << id;
    near += has(all, id) ? 1 : 0;
  }
  EXPECT_GT(near, 5u);
  EXPECT_LT(near, always.size());
  EXPECT_EQ(more.size(), few.size() + near);
}

TEST(RepresentativePoints, MergedGroupsLeaveFewerPointsAndEachOmittedPointHasANearerOneInItsCell) {
  Fit& f = fit();
  RepresentativePoints::Request few = f.request;
  few.most_groups = 200;
  few.most_cell_m = kRadius_m;
  ContactSet set(f.shell.size());
  f.leading.find(f.map, f.X_MP, few, set);
  const double cell_m = f.leading.mergedTo_m();
  ASSERT_GE(cell_m, kTile_m);
  EXPECT_LT(set.contacts.size(), f.lead(f.X_MP).size() / 2);
  EXPECT_LE(set.contacts.size(), 2 * few.most_groups);
  EXPECT_EQ(f.leading.mergedTo_m(), 0) << "the last find() merged nothing";
  const std::vector<Contact> all = f.all(f.X_MP);
  const double tol_m = kVoxel_m / 16384;
  // Cells contain the groups' centres, from which points are at most a tile's size away. Directions of one
  // cell are less than 110 degrees apart, and normals of a group less than 20.
  const double far_m = std::sqrt(3.0) * cell_m + 2 * kTile_m;
  for (const Contact& c : all)
    EXPECT_TRUE(std::any_of(set.contacts.begin(), set.contacts.end(), [&](const Contact& kept) {
      const double cos = f.shell.inward[kept.id].dot(f.shell.inward[c.id]);
      return kept.distance_m <= c.distance_m + tol_m && (kept.p_M - c.p_M).norm() <= far_m && cos > -0.8;
    })) << c.id;
}

TEST(RepresentativePoints, CellsGrowNoLargerThanTheyMay) {
  Fit& f = fit();
  RepresentativePoints::Request few = f.request;
  few.most_groups = 1;
  few.most_cell_m = 2 * kTile_m;
  ContactSet set(f.shell.size());
  f.leading.find(f.map, f.X_MP, few, set);
  EXPECT_EQ(f.leading.mergedTo_m(), 2 * kTile_m);
  EXPECT_GT(set.contacts.size(), 2U);
}

TEST(RepresentativePoints, FewNearPointsAreAllReported) {
  // Lifted along x, the peg touches along a line.
  const Pose X_MP(fit().X_MP.R, {kAir_m, 0, 1e-3});
  fit().request.options.cutoff_m = 2e-6;
  fit().request.full_count = fit().all(X_MP).size() * 3;  // counted in leaves of sixteen
  const std::vector<Contact> some = fit().lead(X_MP), all = fit().all(X_MP);
  fit().request.full_count = 0;
  EXPECT_LT(fit().lead(X_MP).size(), all.size());
  fit().request.options.cutoff_m = 40e-6;
  EXPECT_GT(all.size(), 100u);
  EXPECT_TRUE(isSame(some, all));
}

// A plate's edge is near everywhere: one point represents its neighbours within a quarter of a tile.
TEST(RepresentativePoints, PointsOnEdgesStandForNeighboursOnly) {
  const PointShell shell = buildPointShell(makeBox(Vec3(20e-3, 20e-3, 20e-3)), {0.5e-3, 0.35});
  std::vector<std::uint8_t> on_edge(shell.size());
  for (std::uint32_t id = 0; id < shell.size(); ++id)
    on_edge[id] = (shell.points[id].cwiseAbs().array() > 10e-3 - 1e-9).count() >= 2 ? 1 : 0;
  const double tile_m = 6e-3;
  const RepresentativePoints leading(shell, tile_m, on_edge);
  std::map<std::uint32_t, Box> edges, faces;
  std::size_t loose = 0;  // in leaves that are larger than a tile
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    if (leading.groupOf(id) == RepresentativePoints::kNone)
      ++loose;
    else
      (on_edge[id] != 0 ? edges : faces)[leading.groupOf(id)].add(shell.points[id]);
  }
  EXPECT_LT(loose, shell.size() / 50);
  ASSERT_GT(edges.size(), 12 * 20e-3 / (0.25 * tile_m));
  for (const auto& [group, box] : edges) {
    EXPECT_LE(box.size().norm(), 0.25 * tile_m);
    EXPECT_FALSE(faces.contains(group));
  }
  for (const auto& [group, box] : faces) EXPECT_LE(box.size().minCoeff(), 1e-9);  // each group is on one face
}

TEST(RepresentativePoints, DoesNotAllocateAndRejectsABadPose) {
  ContactSet set(fit().shell.size());
  const vps_test::NoAllocScope guard;
  EXPECT_EQ(fit().leading.find(fit().map, fit().X_MP, fit().request, set).status, Status::Ok);
  EXPECT_EQ(fit().leading.find(fit().map, Pose::translation({NAN, 0, 0}), fit().request, set).status,
            Status::BadPose);
  EXPECT_TRUE(set.contacts.empty());
}

TEST(RepresentativePoints, TilesThatAreTooSmallReportAllPointsAndASizeMustBePositive) {
  RepresentativePoints small(fit().shell, 1e-6);
  EXPECT_FALSE(small.reducesContacts());
  ContactSet set(fit().shell.size());
  EXPECT_EQ(small.find(fit().map, fit().X_MP, fit().request, set).status, Status::Ok);
  EXPECT_TRUE(isSame(set.contacts, fit().all(fit().X_MP)));
  EXPECT_THROW(RepresentativePoints(fit().shell, 0), std::invalid_argument);
}

}  // namespace
}  // namespace vps
