// SPDX-License-Identifier: BSD-3-Clause
// Answers within a budget: exact when it suffices, bounded and continuous when it does not, never over it.
#include "vps/budget_query.h"

#include <gtest/gtest.h>

#include <cmath>

#include "query/cluster_depth.h"
#include "query/cluster_samples.h"
#include "support/analytic.h"
#include "support/fit.h"
#include "support/gear.h"
#include "support/no_alloc.h"
#include "support/screw.h"

namespace vps {
namespace {

using test::RandomPoints;

constexpr double kMm = 1e-3, kUm = 1e-6, kStiffness = 1e11;
const Vec3 kO(1 * kMm, 2 * kMm, -3 * kMm);

struct scenes::Scene {
  const char* name;
  VoxMap map;
  PointShell shell;
  Pose touching;
  double size_m;
};

scenes::Scene pegInPlate() {
  const Mesh plate = test::makeBoredPlate({.side_m = 30 * kMm, .bore_m = 5.02 * kMm, .columns = 96});
  const Mesh peg = test::makePeg({.length_m = 30 * kMm, .columns = 96, .rows = 20});
  return {"peg in plate", buildVoxMap(plate, {0.2 * kMm, 4}), buildPointShell(peg, {0.3 * kMm, 0.35}),
          Pose::translation({40 * kUm, 0, 8 * kMm}), 10 * kMm};
}

scenes::Scene planetInRing() {
  const test::GearShape ring{.teeth = 48, .other_radius_m = 28 * kMm, .points_per_tooth = 16},
      planet{.teeth = 20, .width_m = 8 * kMm, .other_radius_m = 4 * kMm, .points_per_tooth = 16};
  return {"planet in ring", buildVoxMap(test::makeRingGear(ring), {0.2 * kMm, 4}),
          buildPointShell(test::makeSpurGear(planet), {0.25 * kMm, 0.35}),
          Pose::translation({14.03 * kMm, 0.02 * kMm, 0}), 10 * kMm};
}

scenes::Scene rodInNut() {
  test::ThreadShape rod{.length_m = 10 * kMm, .columns = 48, .rows_per_pitch = 16};
  const Mesh rod_mesh = test::makeThreadedRod(rod);
  rod.clearance_m = 0.05 * kMm;
  return {"rod in nut", buildVoxMap(test::makeNut(rod, 11 * kMm), {0.15 * kMm, 4}),
          buildPointShell(rod_mesh, {0.2 * kMm, 0.35}),
          Pose::translation({5 * kUm, 0, 0.05 * kMm / std::sqrt(3.0) + 5 * kUm}), 6 * kMm};
}

const std::vector<scenes::Scene>& scenes() {
  static const std::vector<scenes::Scene> all = [] {
    std::vector<scenes::Scene> s;
    s.push_back(pegInPlate());
    s.push_back(planetInRing());
    s.push_back(rodInNut());
    const Mesh box = makeBox({6 * kMm, 5 * kMm, 4 * kMm});
    s.push_back({"one leaf", buildVoxMap(box, {0.5 * kMm, 3}),
                 buildPointShell(makeBox({1 * kMm, 1 * kMm, 1 * kMm}), {1 * kMm, 0.35}),
                 Pose::translation({0, 0, 2.4 * kMm}), 4 * kMm});
    return s;
  }();
  return all;
}

/// Around the touching pose, by a micrometre to a tenth of the part's size.
std::vector<Pose> posesOf(const scenes::Scene& scene, int count, unsigned seed) {
  RandomPoints random(seed);
  std::vector<Pose> poses = {scene.touching};
  while (static_cast<int>(poses.size()) < count) {
    const double way_m = scene.size_m * std::pow(10.0, -2.5 + 1.5 * random.unit());
    poses.emplace_back(
        Mat3(rotationFromVector(random.inBox(Vec3::Constant(way_m / scene.size_m))) * scene.touching.R),
        scene.touching.p + random.inBox(Vec3::Constant(way_m)));
  }
  return poses;
}

void expectSame(const TouchSummary& a, const TouchSummary& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.F_O_M.f, b.F_O_M.f);
  EXPECT_EQ(a.F_O_M.tau, b.F_O_M.tau);
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.volume_m3, b.volume_m3);
  EXPECT_EQ(a.max_depth_m, b.max_depth_m);
}

class BudgetQueryTest : public testing::TestWithParam<int> {
 protected:
  const scenes::Scene& scene = scenes()[static_cast<std::size_t>(GetParam())];
  BudgetQuery query{scene.map, scene.shell};

  [[nodiscard]] TouchSummary exact(const Pose& X_MP, Gradient gradient = Gradient::Continuous) const {
    TouchSummary sum;
    queryWrench(scene.map, scene.shell, X_MP, {.gradient = gradient}, kStiffness, kO, sum);
    return sum;
  }
  TouchSummary within(const QueryBudget& budget, const Pose& X_MP, BudgetReport& report,
                      const QueryOptions& options = {}) {
    TouchSummary sum;
    report = query.run(X_MP, options, kStiffness, kO, budget, sum);
    return sum;
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, BudgetQueryTest, testing::Range(0, 4));

TEST_P(BudgetQueryTest, WithoutALimitTheAnswerIsQueryWrenchToTheBit) {
  std::size_t touching = 0;
  for (const Gradient gradient : {Gradient::Continuous, Gradient::Trilinear})
    for (const Pose& X_MP : posesOf(scene, 60, 11)) {
      BudgetReport report;
      const TouchSummary got = within({}, X_MP, report, {.gradient = gradient}), all = exact(X_MP, gradient);
      expectSame(got, all);
      touching += all.count;
      EXPECT_TRUE(report.is_complete);
      EXPECT_EQ(report.status, Status::Ok);
      EXPECT_EQ(report.clusters_left, 0u);
      EXPECT_EQ(report.force_error_N, 0);
      EXPECT_EQ(report.coarsest_level, 0);
    }
  EXPECT_GT(touching, 100u);
}

TEST_P(BudgetQueryTest, NeverReadsMoreThanItsBudgetAndSaysWhatItLeftOut) {
  for (const Pose& X_MP : posesOf(scene, 20, 12)) {
    const TouchSummary all = exact(X_MP);
    QueryOptions exhaustive;
    exhaustive.is_exhaustive = true;
    ContactSet none(0);
    const double least_m = queryContacts(scene.map, scene.shell, X_MP, exhaustive, none).min_distance_m;
    for (std::size_t max_points = 0; max_points < 40'000; max_points += 1 + max_points / 2) {
      BudgetReport report;
      const TouchSummary got = within({.max_points = max_points}, X_MP, report);
      EXPECT_LE(report.points_read, max_points);
      EXPECT_EQ(report.is_complete, report.status == Status::Ok);
      EXPECT_EQ(report.is_complete, report.clusters_left == 0);
      EXPECT_EQ(report.is_complete, report.area_left_m2 == 0);
      // Sums of floats' roundings: 1e-6 of the force.
      const double rounding_N = 1e-6 * all.F_O_M.f.norm();
      EXPECT_LE((got.F_O_M.f - all.F_O_M.f).norm(), report.force_error_N + rounding_N);
      EXPECT_LE((got.F_O_M.tau - all.F_O_M.tau).norm(), report.torque_error_Nm + rounding_N * scene.size_m);
      EXPECT_LE(all.max_depth_m, report.depth_bound_m);
      // The greatest depth and least distance are of floats, in quanta.
      EXPECT_LE(report.least_distance_m, least_m + 1e-6 * scene.map.voxel_m());
      EXPECT_GE(report.nearest_read_m, least_m);
      if (report.is_complete) expectSame(got, all);
    }
  }
}

TEST_P(BudgetQueryTest, NothingToSpendGivesNoForceAndTheWholeBound) {
  for (const std::size_t max_points : {0u, 1u}) {
    BudgetReport report;
    const TouchSummary sum = within({.max_points = max_points}, scene.touching, report);
    EXPECT_EQ(sum.F_O_M.f, Vec3::Zero());
    EXPECT_EQ(report.status, Status::Truncated);
    EXPECT_FALSE(report.is_complete);
    EXPECT_EQ(report.points_read, max_points);
    EXPECT_EQ(report.clusters_left, 1u);
    double area_m2 = 0;
    for (const double a : scene.shell.area_m2) area_m2 += a;
    EXPECT_NEAR(report.area_left_m2, area_m2, 1e-6 * area_m2);  // summed in floats of 16 points
    EXPECT_LE(report.force_error_N, kStiffness * area_m2 * scene.map.band_m() * (1 + 1e-4));
    EXPECT_GT(report.force_error_N, 0);
  }
}

TEST_P(BudgetQueryTest, FarAwayOneReadingTellsThatNothingTouches) {
  BudgetReport report;
  const Pose X_MP(scene.touching.R, scene.touching.p + Vec3(1, 2, -3));
  const TouchSummary sum = within({.max_points = 1}, X_MP, report);
  EXPECT_TRUE(report.is_complete);
  EXPECT_EQ(sum.count, 0u);
  EXPECT_EQ(report.least_distance_m, scene.map.band_m());
}

TEST_P(BudgetQueryTest, PointsAloneGiveTheSameBitsOnEveryProcessorAndEveryTime) {
  BudgetQuery other(scene.map, scene.shell);
  for (const Pose& X_MP : posesOf(scene, 20, 13))
    for (const std::size_t max_points : {40u, 300u, 2000u, 9000u}) {
      BudgetReport first, again;
      const TouchSummary expected = within({.max_points = max_points}, X_MP, first, {.simd = Simd::Scalar});
      for (const Simd simd : {Simd::Avx2, Simd::Avx512, Simd::Best}) {
        expectSame(within({.max_points = max_points}, X_MP, again, {.simd = simd}), expected);
        EXPECT_EQ(first.points_read, again.points_read);
        EXPECT_EQ(first.force_error_N, again.force_error_N);
        EXPECT_EQ(first.least_distance_m, again.least_distance_m);
      }
      TouchSummary sum;
      other.run(X_MP, {}, kStiffness, kO, {.max_points = max_points}, sum);
      expectSame(sum, expected);
    }
}

TEST_P(BudgetQueryTest, NeitherPointsNorTimeMakeItAllocate) {
  const vps_test::NoAllocScope guard;
  TouchSummary sum;
  for (const Pose& X_MP : {scene.touching, Pose()})
    for (const Gradient gradient : {Gradient::Continuous, Gradient::Trilinear})
      for (const QueryBudget& budget : {QueryBudget{}, QueryBudget{500, 1e9}, QueryBudget{5000, 20}})
        query.run(X_MP, {.gradient = gradient}, kStiffness, kO, budget, sum);
}

TEST_P(BudgetQueryTest, ATimeThatSufficesIsExactAndATimeOfNothingIsDefined) {
  BudgetReport report;
  const TouchSummary all = exact(scene.touching);
  expectSame(within({.max_us = 1e30}, scene.touching, report), all);
  EXPECT_TRUE(report.is_complete);
  for (const double max_us : {0.0, -1.0, std::nan(""), 1e-9}) {
    const TouchSummary sum = within({.max_us = max_us}, scene.touching, report);
    EXPECT_FALSE(report.is_complete);
    EXPECT_EQ(sum.F_O_M.f, Vec3::Zero());
    EXPECT_GE(report.force_error_N, all.F_O_M.f.norm());
  }
}

/// Not a test of the machine: it is only printed how late a call ends.
TEST_P(BudgetQueryTest, ATimeBudgetIsBoundedByTheReportWhateverTheClockSays) {
  const TouchSummary all = exact(scene.touching);
  for (const double max_us : {5.0, 20.0, 100.0}) {
    std::vector<double> late_us;
    for (int i = 0; i < 200; ++i) {
      BudgetReport report;
      const TouchSummary got = within({.max_us = max_us}, scene.touching, report);
      EXPECT_LE((got.F_O_M.f - all.F_O_M.f).norm(), report.force_error_N + 1e-6 * all.F_O_M.f.norm());
      if (report.is_complete) expectSame(got, all);
      late_us.push_back(report.time_us - max_us);
    }
    std::sort(late_us.begin(), late_us.end());
    std::printf("  %s, %g us: late by %.1f us at the median, %.1f at p99, %.1f at most\n", scene.name, max_us,
                late_us[100], late_us[198], late_us[199]);
  }
}

TEST_P(BudgetQueryTest, APoseThatIsNoPoseGivesNothing) {
  BudgetReport report;
  Pose X_MP = scene.touching;
  X_MP.p.x() = std::nan("");
  const TouchSummary sum = within({}, X_MP, report);
  EXPECT_EQ(report.status, Status::BadPose);
  EXPECT_FALSE(report.is_complete);
  EXPECT_EQ(sum.F_O_M.f, Vec3::Zero());
  // Finite, but beyond what a position can be.
  X_MP.p = Vec3(1e300, -1e300, 1e308);
  within({}, X_MP, report);
  EXPECT_TRUE(report.is_complete);
}

/// A straight way through the touching pose, turning a little.
Pose along(const scenes::Scene& scene, double s_m) {
  const Vec3 way = Vec3(1, 0.7, -0.4).normalized();
  return {Mat3(rotationFromVector(Vec3(0, 0, 0.2 * s_m / scene.size_m)) * scene.touching.R),
          scene.touching.p + s_m * way};
}

struct Steepest {
  double N_per_m = 0, at_m = 0;
};

/// The greatest change of a force over `count` steps from `from_m` on.
template <typename Force>
Steepest steepest(double from_m, double step_m, int count, const Force& force) {
  Steepest found;
  Vec3 last_N = force(from_m);
  for (int i = 1; i <= count; ++i) {
    const Vec3 f_N = force(from_m + i * step_m);
    const double N_per_m = (f_N - last_N).norm() / step_m;
    if (N_per_m > found.N_per_m) found = {N_per_m, from_m + (i - 1) * step_m};
    last_N = f_N;
  }
  return found;
}

TEST_P(BudgetQueryTest, TheForceHasNoStepsHoweverFineThePosesLie) {
  // Wherever the force changes most over a micrometre, it is looked at in steps of a tenth, and of a
  // hundredth where that changes most. A step of the force would be ten times as steep each time.
  // A field that places points to whole steps of its own has small ones, with a budget or without.
  constexpr double kLength_m = 400 * kUm;
  const auto unlimited = [&](double s_m) -> Vec3 { return exact(along(scene, s_m)).F_O_M.f; };
  const Steepest all = steepest(-kLength_m / 2, 1 * kUm, 400, unlimited);
  for (const std::size_t max_points : {100u, 500u, 1000u, 2000u, 4000u, 8000u}) {
    const auto force = [&](double s_m) -> Vec3 {
      BudgetReport report;
      return within({.max_points = max_points}, along(scene, s_m), report).F_O_M.f;
    };
    const Steepest coarse = steepest(-kLength_m / 2, 1 * kUm, 400, force);
    const Steepest fine = steepest(coarse.at_m, 0.1 * kUm, 10, force);
    const Steepest finest = steepest(fine.at_m, 0.01 * kUm, 10, force);
    std::printf(
        "  %s, %zu points: %.3g N/m at 1 um, %.3g at 0.1 um, %.3g at 0.01 um; without a budget %.3g\n",
        scene.name, max_points, coarse.N_per_m, fine.N_per_m, finest.N_per_m, all.N_per_m);
    const Steepest here = steepest(fine.at_m, 0.01 * kUm, 10, unlimited);
    EXPECT_LE(finest.N_per_m, 3 * std::max({coarse.N_per_m, all.N_per_m, here.N_per_m}));
  }
}

TEST(ClusterBounds, NoPointOfAClusterIsDeeperThanItsBound) {
  for (const scenes::Scene& scene : scenes()) {
    const ClusterSamples samples = clusterSamples(scene.shell);
    for (const Pose& X_MP : posesOf(scene, 12, 14)) {
      const scenes::Reading reading(scene.map, scene.shell, X_MP, Simd::Best);
      for (std::size_t b = scene.shell.leaf_blocks; b < scene.shell.blocks.size(); ++b) {
        ClusterBounds bounds;
        boundClusters(reading, samples.spheres[b - scene.shell.leaf_blocks], bounds);
        for (std::uint32_t i = 0; i < scene.shell.blocks[b].count; ++i) {
          std::uint32_t low = scene.shell.blocks[b].first + i, high = low;
          while (!scene.shell.blocks[low].is_leaf) low = scene.shell.blocks[low].first;
          while (!scene.shell.blocks[high].is_leaf)
            high = scene.shell.blocks[high].first + scene.shell.blocks[high].count - 1;
          const std::uint32_t end = scene.shell.blocks[high].first + scene.shell.blocks[high].count;
          for (std::uint32_t id = scene.shell.blocks[low].first; id < end; ++id) {
            const double voxels = scene.map.distance(X_MP * scene.shell.points[id]) / scene.map.voxel_m();
            // Readings round positions to 1e-4 voxel at most.
            ASSERT_GE(voxels, -static_cast<double>(bounds.depth[i]) - 1e-3) << scene.name << " block " << b;
          }
        }
      }
    }
  }
}

TEST(ClusterSamples, ASampleIsAPointOfItsClusterAndStandsForItsArea) {
  const PointShell& shell = scenes()[0].shell;
  const ClusterSamples samples = clusterSamples(shell);
  ASSERT_EQ(samples.points.blocks.size(), shell.blocks.size() - shell.leaf_blocks);
  // The root's children cover the shell; the sum is of floats.
  double area_m2 = 0, covered_m2 = 0;
  for (const double a : shell.area_m2) area_m2 += a;
  for (const float a : samples.points.blocks.back().weight) covered_m2 += static_cast<double>(a);
  EXPECT_NEAR(covered_m2, area_m2, 1e-6 * area_m2);
  const ShellBlock& parent = shell.blocks[shell.leaf_blocks];
  for (std::uint32_t i = 0; i < parent.count; ++i) {
    const ShellBlock& leaf = shell.blocks[parent.first + i];
    bool is_found = false;
    for (std::uint32_t id = leaf.first; id < leaf.first + leaf.count; ++id)
      is_found |= shell.points[id] == samples.points.points[i];
    EXPECT_TRUE(is_found) << i;
  }
}

TEST(BudgetQuery, TakesNoMoreRoomThanItSays) {
  for (const scenes::Scene& scene : scenes()) {
    const double leaves = static_cast<double>(scene.shell.size()) / 16;
    // Beside the buckets, which every one has.
    EXPECT_LE(static_cast<double>(BudgetQuery(scene.map, scene.shell).memoryBytes()), 130 * leaves + 20e3);
  }
}

TEST(BudgetQuery, AnEmptyShellOrMapTouchesNothing) {
  const PointShell none;
  BudgetQuery without_points(scenes()[0].map, none), without_map(VoxMap(), scenes()[0].shell);
  TouchSummary sum;
  for (BudgetQuery* query : {&without_points, &without_map}) {
    const BudgetReport report = query->run(Pose(), {}, kStiffness, kO, {.max_points = 100}, sum);
    EXPECT_TRUE(report.is_complete);
    EXPECT_EQ(sum.count, 0u);
  }
}

}  // namespace
}  // namespace vps
