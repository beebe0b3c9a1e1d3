// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps that are fine in regions only, against the fine and the coarse map they stand for.
#include <gtest/gtest.h>

#include <cmath>

#include "support/analytic.h"
#include "support/no_alloc.h"
#include "voxmap/read_kernel.h"
#include "vps/budget_query.h"
#include "vps/load_error.h"
#include "vps/query.h"

namespace vps::test {
namespace {

constexpr double kVoxel_m = 0.1e-3, kBore_m = 5.02e-3;

Box boxOf(const Vec3& min, const Vec3& max) {
  Box box;
  box.add(min);
  box.add(max);
  return box;
}

FineRegions within(const std::vector<Box>& boxes_M, int coarsening) {
  FineRegions regions;
  regions.boxes_M = boxes_M;
  regions.coarsening = coarsening;
  return regions;
}

struct RegionCase {
  const char* name;
  Mesh mesh;
  FineRegions regions;
  Mesh other;  ///< what touches it
  Pose X_MP;   ///< where that is in contact on both sides of a region's border
};

const std::vector<RegionCase>& cases() {
  static const std::vector<RegionCase> all = [] {
    std::vector<RegionCase> c(3);
    c[0].name = "a quarter of a bore";
    c[0].mesh = makeTube(8e-3, kBore_m, 10e-3, 96);
    c[0].regions = within({boxOf({3e-3, -2e-3, -1e-3}, {6e-3, 2e-3, 3e-3})}, 4);
    c[0].other = makeCylinder(5e-3, 6e-3, 96);
    c[0].X_MP = Pose::translation({10e-6, 0, 0});
    // Edges and corners cut by borders, and two regions that overlap.
    c[1].name = "a turned block";
    c[1].mesh = transformed(makeBox({8e-3, 6e-3, 5e-3}), RandomPoints(51).pose(1e-3));
    c[1].regions =
        within({boxOf(Vec3::Zero(), Vec3::Constant(5e-3)), boxOf({-2e-3, -1e-3, 0}, {1e-3, 4e-3, 3e-3})}, 2);
    c[1].other = makeSphere(1.5e-3, 4);
    c[1].X_MP = Pose::translation({0, 0, 4e-3});
    c[2].name = "one brick";
    c[2].mesh = makeSphere(4e-3, 5);
    c[2].regions = within({boxOf({3.9e-3, 0, 0}, {3.9e-3, 0, 0})}, 8);
    c[2].other = makeBox({2e-3, 2e-3, 2e-3});
    c[2].X_MP = Pose::translation({4.9e-3, 0, 0});
    return c;
  }();
  return all;
}

VoxMap mapOf(const RegionCase& c) {
  return buildVoxMapInRegions(c.mesh, {kVoxel_m, 4}, c.regions);
}

class RegionsTest : public testing::TestWithParam<int> {
 protected:
  const RegionCase& case_ = cases()[static_cast<std::size_t>(GetParam())];
  const VoxMap map_ = mapOf(case_);
  const int steps_ = case_.regions.coarsening;

  [[nodiscard]] bool isFine(const Vec3& p) const { return map_.voxelAt(p) == kVoxel_m; }
  /// All cells that p's cell shares a node with are in bricks too: no node is the coarse field's.
  [[nodiscard]] bool isDeepFine(const Vec3& p) const {
    for (int k = 0; k < 27; ++k)
      if (!isFine(p + 1.01 * kVoxel_m * Vec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1))) return false;
    return true;
  }
  /// Poses about the one in contact, most of them in small steps.
  [[nodiscard]] std::vector<Pose> motion(int count, unsigned seed) const {
    RandomPoints random(seed);
    std::vector<Pose> poses = {case_.X_MP};
    for (int n = 1; n < count; ++n) {
      const double way_m = 1e-3 * std::pow(10.0, -3 + 2.5 * std::abs(random.unit()));
      const Pose& from = n % 17 == 0 ? case_.X_MP : poses.back();
      poses.emplace_back(Mat3(rotationFromVector(20 * way_m * random.inBox(Vec3::Ones())) * from.R),
                         from.p + way_m * random.inBox(Vec3::Ones()));
    }
    return poses;
  }
};
INSTANTIATE_TEST_SUITE_P(Cases, RegionsTest, testing::Range(0, 3));

TEST_P(RegionsTest, ItIsTheFineMapInRegionsAndTheCoarseOneElsewhere) {
  const double band = std::max(4.0, 3.0 * steps_);
  const VoxMap fine = buildVoxMap(case_.mesh, {kVoxel_m, band});
  const VoxMap coarse = buildVoxMap(case_.mesh, {kVoxel_m * steps_, band / steps_});
  EXPECT_EQ(map_.band_m(), fine.band_m());
  EXPECT_EQ(map_.quantum_m(), coarse.quantum_m());
  RandomPoints random(52);
  int in_fine = 0, in_coarse = 0;
  for (int n = 0; n < 200000; ++n) {
    const Vec3 p = n % 3 == 0 ? Vec3(case_.regions.boxes_M[0].center() + random.inBox(Vec3::Constant(1e-3)))
                              : Vec3(map_.bounds().center() + random.inBox(0.6 * map_.bounds().size()));
    if (isDeepFine(p)) {
      // Grids that begin elsewhere round a float's last digit differently.
      ASSERT_NEAR(map_.distance(p), fine.distance(p), 1.01 * map_.quantum_m()) << p.transpose();
      ++in_fine;
    } else if (!isFine(p)) {
      ASSERT_NEAR(map_.distance(p), coarse.distance(p), 0.51 * map_.quantum_m()) << p.transpose();
      ++in_coarse;
    }
  }
  EXPECT_GT(in_fine, 100);
  EXPECT_GT(in_coarse, 10000);
  for (const Box& box : case_.regions.boxes_M) {
    const VoxMap::Sample sample = fine.sample(box.center());
    if (std::abs(sample.distance_m) < 0.5 * fine.band_m()) {
      EXPECT_TRUE(isFine(box.center()));
    }
  }
}

TEST_P(RegionsTest, DistanceNeverJumpsAcrossABorder) {
  RandomPoints random(53);
  const double step_m = 0.01 * kVoxel_m;
  const double slope = static_cast<double>(FieldView(map_).slope);
  int crossings = 0;
  for (int line = 0; line < 400; ++line) {
    const Box& box = case_.regions.boxes_M[static_cast<std::size_t>(line) % case_.regions.boxes_M.size()];
    Vec3 p = box.center() + random.inBox(0.6 * box.size() + Vec3::Constant(8 * kVoxel_m));
    const Vec3 step = step_m * random.inBox(Vec3::Ones()).normalized();
    double last_m = map_.distance(p);
    bool was_fine = isFine(p);
    for (int n = 0; n < 2000; ++n) {
      p += step;
      const double d = map_.distance(p);
      ASSERT_LE(std::abs(d - last_m), slope * step_m + 1e-7 * map_.band_m()) << p.transpose();
      crossings += was_fine != isFine(p);
      was_fine = isFine(p);
      last_m = d;
    }
  }
  EXPECT_GT(crossings, 50);
}

TEST_P(RegionsTest, CulledAndCoherentAnswersAreTheExhaustiveOne) {
  const PointShell shell = buildPointShell(case_.other, {0.15e-3, 0.35});
  ContactSet culled(shell.size()), coherent(shell.size()), scalar(shell.size()), all(shell.size());
  for (const Gradient gradient : {Gradient::Trilinear, Gradient::Continuous})
    for (const double cutoff_m : {0.0, 30e-6, 0.9 * map_.band_m()}) {
      QueryMemory memory(map_, shell);
      std::size_t fine = 0, coarse = 0, read = 0, visited = 0;
      for (const Pose& X_MP : motion(60, 54)) {
        QueryOptions options;
        options.cutoff_m = cutoff_m;
        options.gradient = gradient;
        const QueryResult a = queryContacts(map_, shell, X_MP, options, culled);
        queryContacts(map_, shell, X_MP, options, coherent, &memory);
        options.is_exhaustive = true;
        const QueryResult b = queryContacts(map_, shell, X_MP, options, all);
        options.simd = Simd::Scalar;
        queryContacts(map_, shell, X_MP, options, scalar);
        for (const ContactSet* some : {&culled, &coherent, &scalar}) {
          ASSERT_EQ(some->contacts.size(), all.contacts.size()) << case_.name << ", cutoff " << cutoff_m;
          for (std::size_t i = 0; i < all.contacts.size(); ++i) {
            const Contact &c = some->contacts[i], &e = all.contacts[i];
            ASSERT_TRUE(c.id == e.id && c.distance_m == e.distance_m && c.n_M == e.n_M && c.p_M == e.p_M);
          }
        }
        if (!all.contacts.empty()) {
          ASSERT_EQ(queryDistance(map_, shell, X_MP).min_distance_m, b.min_distance_m);
        }
        for (const Contact& c : all.contacts) {
          ++(isFine(c.p_M) ? fine : coarse);
          // One point read alone gives the same; positions in floats differ by 1e-4 voxel at most.
          ASSERT_NEAR(c.distance_m, map_.distance(c.p_M), 5e-4 * kVoxel_m);
          const Vec3 n_M = map_.normal(c.p_M, gradient);
          if (gradient == Gradient::Continuous && !n_M.isZero()) {
            // Its differences are over two voxels, and lengths mostly near 1.
            ASSERT_LT((c.n_M - n_M).norm(), 0.02);
          }
        }
        read += a.points_tested;
        visited += b.points_tested;
      }
      EXPECT_GT(fine, 100u) << case_.name;
      EXPECT_GT(coarse, 100u) << case_.name;
      EXPECT_LE(read, visited);
      if (cutoff_m == 0) {
        EXPECT_LT(read, visited);
      }
    }
}

TEST_P(RegionsTest, TheWrenchHasTheSameBitsCulledCoherentAndSharedAndNothingAllocates) {
  const PointShell shell = buildPointShell(case_.other, {0.15e-3, 0.35});
  QueryMemory memory(map_, shell);
  QueryTeam team(2);
  const auto poses = motion(80, 55);
  std::size_t touching = 0;
  for (const Gradient gradient : {Gradient::Trilinear, Gradient::Continuous})
    for (const Pose& X_MP : poses) {
      TouchSummary expected, got[3];
      QueryOptions options, shared;
      options.gradient = shared.gradient = gradient;
      shared.team = &team;
      {
        vps_test::NoAllocScope guard;
        queryWrench(map_, shell, X_MP, options, 1e11, Vec3::Zero(), got[0]);
        queryWrench(map_, shell, X_MP, options, 1e11, Vec3::Zero(), got[1], &memory);
        queryWrench(map_, shell, X_MP, shared, 1e11, Vec3::Zero(), got[2]);
        options.is_exhaustive = true;
        queryWrench(map_, shell, X_MP, options, 1e11, Vec3::Zero(), expected);
      }
      for (const TouchSummary& sum : got) {
        ASSERT_EQ(sum.count, expected.count);
        ASSERT_EQ(sum.F_O_M.f, expected.F_O_M.f);
        ASSERT_EQ(sum.F_O_M.tau, expected.F_O_M.tau);
        ASSERT_EQ(sum.max_depth_m, expected.max_depth_m);
      }
      touching += expected.count;
    }
  EXPECT_GT(touching, 1000u);
}

TEST_P(RegionsTest, NoReadingIsBelowWhatABoundAllows) {
  RandomPoints random(56);
  for (int n = 0; n < 100000; ++n) {
    const Vec3 p = map_.bounds().center() + random.inBox(map_.bounds().size());
    const Vec3 way = random.inBox(Vec3::Constant(2e-3)) * random.unit();
    const double least_m = std::min(map_.leastDistance(p) - way.norm(), map_.band_m()) - map_.sampleError_m();
    ASSERT_GE(map_.distance(p + way), least_m) << p.transpose() << " by " << way.transpose();
  }
}

TEST_P(RegionsTest, ABudgetThatSufficesIsTheWrenchToTheBitAndLessIsWithinItsBound) {
  const PointShell shell = buildPointShell(case_.other, {0.15e-3, 0.35});
  BudgetQuery query(map_, shell);
  std::size_t touching = 0;
  for (const Gradient gradient : {Gradient::Trilinear, Gradient::Continuous})
    for (const Pose& X_MP : motion(40, 57)) {
      QueryOptions options;
      options.gradient = gradient;
      TouchSummary all, got;
      queryWrench(map_, shell, X_MP, options, 1e11, Vec3::Zero(), all);
      EXPECT_TRUE(query.run(X_MP, options, 1e11, Vec3::Zero(), {}, got).is_complete);
      ASSERT_EQ(got.count, all.count);
      ASSERT_EQ(got.F_O_M.f, all.F_O_M.f);
      ASSERT_EQ(got.F_O_M.tau, all.F_O_M.tau);
      ASSERT_EQ(got.max_depth_m, all.max_depth_m);
      for (const std::size_t max_points : {100u, 1000u}) {
        const BudgetReport report =
            query.run(X_MP, options, 1e11, Vec3::Zero(), {.max_points = max_points}, got);
        // Sums of floats' roundings: 1e-6 of the force.
        ASSERT_LE((got.F_O_M.f - all.F_O_M.f).norm(), report.force_error_N + 1e-6 * all.F_O_M.f.norm());
        ASSERT_LE(all.max_depth_m, report.depth_bound_m);
      }
      touching += all.count;
    }
  EXPECT_GT(touching, 1000u);
}

TEST(Regions, ABudgetIsSpentWhereItTouches) {
  // A peg in a bore that touches at its +x side, where the region is. All else is as near as the clearance.
  const Mesh bore = makeTube(8e-3, kBore_m, 10e-3, 96), peg = makeCylinder(5e-3, 6e-3, 96);
  const VoxMap by_regions =
      buildVoxMapInRegions(bore, {kVoxel_m, 4}, within({boxOf({3e-3, -4e-3, -4e-3}, {6e-3, 4e-3, 4e-3})}, 4));
  const VoxMap whole = buildVoxMap(bore, {kVoxel_m, 12});
  const PointShell shell = buildPointShell(peg, {0.1e-3, 0.35});
  BudgetQuery in_regions(by_regions, shell), in_whole(whole, shell);
  const auto run = [&](const VoxMap& map, BudgetQuery& query, const Pose& X_MP, std::size_t max_points,
                       BudgetReport& report) {
    TouchSummary all, got;
    queryWrench(map, shell, X_MP, {}, 1e11, Vec3::Zero(), all);
    EXPECT_GT(all.count, 3000u);
    report = query.run(X_MP, {}, 1e11, Vec3::Zero(), {.max_points = max_points}, got);
    return (got.F_O_M.f - all.F_O_M.f).norm();
  };
  // Twice is allowed for: the coarse field is off by up to 4.3 voxels where the fine one is by 0.9, so that
  // depths are bounded less well. About 4000 points it costs more, since there the fine map's budget begins
  // to suffice for all but the peg's end faces.
  for (const double x_um : {22.0, 26.0, 30.0})
    for (const std::size_t max_points : {500u, 1000u, 2000u, 8000u}) {
      const Pose X_MP = Pose::translation({x_um * 1e-6, 0, 0});
      BudgetReport of_fine, of_regions;
      const double fine_N = run(whole, in_whole, X_MP, max_points, of_fine);
      EXPECT_LE(run(by_regions, in_regions, X_MP, max_points, of_regions), 2 * fine_N) << max_points;
      EXPECT_LE(of_regions.force_error_N, 2 * of_fine.force_error_N) << max_points;
    }
}

TEST(Regions, TheyTakeLessMemory) {
  const RegionCase& c = cases()[0];
  const VoxMap map = mapOf(c), whole = buildVoxMap(c.mesh, {kVoxel_m, 12});
  EXPECT_LT(map.memoryBytes(), whole.memoryBytes() / 4);
  EXPECT_EQ(map.voxelAt({kBore_m, 0, 0}), kVoxel_m);
  EXPECT_EQ(map.voxelAt({-kBore_m, 0, 0}), 4 * kVoxel_m);
  EXPECT_EQ(whole.voxelAt({-kBore_m, 0, 0}), kVoxel_m);
}

TEST(Regions, WhatCannotBeDoneIsRefusedWithARemedy) {
  const auto complaint = [](auto act) -> std::string {
    try {
      act();
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  };
  const Mesh box = makeBox({4e-3, 4e-3, 4e-3});
  const VoxMap map =
      buildVoxMapInRegions(box, {kVoxel_m, 4}, within({boxOf({0, 0, 0}, {3e-3, 3e-3, 3e-3})}, 4));
  const VoxMap other = buildVoxMap(box, {kVoxel_m, 12});
  const auto build = [&](const FineRegions& regions) {
    return complaint([&] { buildVoxMapInRegions(box, {kVoxel_m, 4}, regions, "hub"); });
  };
  EXPECT_NE(build(within({}, 4)).find("part 'hub': no fine region is given"), std::string::npos);
  EXPECT_NE(build(within({Box()}, 4)).find("is no box"), std::string::npos);
  EXPECT_NE(build(within({boxOf({0, 0, 0}, {1, 1, 1})}, 3)).find("by 2, 4 or 8"), std::string::npos);
  const char* said = "fine in regions only cannot be";
  EXPECT_NE(complaint([&] { (void)unionOf(map, other); }).find(said), std::string::npos);
  EXPECT_NE(complaint([&] { (void)differenceOf(other, map); }).find(said), std::string::npos);
  EXPECT_NE(complaint([&] {
              (void)mountVoxMap(other, PlacedMap{&map, Pose()});
            }).find(said),
            std::string::npos);
  EXPECT_NE(complaint([&] {
              (void)mountVoxMap(map, PlacedMap{&other, Pose()});
            }).find(said),
            std::string::npos);
}

}  // namespace
}  // namespace vps::test
