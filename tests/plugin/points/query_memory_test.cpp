// SPDX-License-Identifier: BSD-3-Clause
// With temporal coherence the answer equals the exhaustive one to the bit, for any motion.
#include "vps/query_memory.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "support/no_alloc.h"
#include "support/random_draw.h"
#include "vps/pointshell.h"
#include "vps/query.h"

namespace vps {
namespace {

constexpr double kStiffness = 1e11;

struct Scene {
  const char* name;
  VoxMap map;
  PointShell shell;
  Pose start;
  double size_m;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = [] {
    const Mesh bore = makeTube(8 * kMm, 5.02 * kMm, 10 * kMm, 64), peg = makeCylinder(5 * kMm, 12 * kMm, 64);
    const Mesh box = makeBox({6 * kMm, 5 * kMm, 4 * kMm}), plate = makeBox({12 * kMm, 12 * kMm, 0.3 * kMm});
    std::vector<Scene> s;
    s.push_back({"peg in bore", buildVoxMap(bore, {0.25 * kMm, 4}), buildPointShell(peg, {0.15 * kMm, 0.35}),
                 Pose(), 9 * kMm});
    s.push_back({"box on thin plate", buildVoxMap(plate, {0.2 * kMm, 3}),
                 buildPointShell(box, {0.25 * kMm, 0.35}), Pose::translation({0, 0, 2.2 * kMm}), 6 * kMm});
    s.push_back({"one leaf", buildVoxMap(box, {0.5 * kMm, 3}),
                 buildPointShell(makeBox({1 * kMm, 1 * kMm, 1 * kMm}), {1 * kMm, 0.35}),
                 Pose::translation({0, 0, 2.4 * kMm}), 4 * kMm});
    return s;
  }();
  return all;
}

/// Steps of every length from a nanometre to the part's size, drifting and jumping back, rotating in place,
/// and at rest.
std::vector<Pose> motion(const Scene& scene, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return test::drawnVector(unit, random); };
  std::vector<Pose> poses = {scene.start};
  for (int i = 1; i < count; ++i) {
    const double way_m = scene.size_m * std::pow(10.0, -3.5 + 3.5 * unit(random));
    const Pose& last = poses.back();
    const int kind = static_cast<int>(2.5 * (1 + unit(random)));
    if (kind == 0) poses.push_back(last);
    if (kind == 1) poses.emplace_back(last.R, last.p + way_m * vec());
    if (kind == 2)
      poses.emplace_back(Mat3(rotationFromVector(way_m / scene.size_m * vec()) * last.R), last.p);
    if (kind == 3)
      poses.push_back(Pose{Mat3(rotationFromVector(0.1 * way_m / scene.size_m * vec()) * last.R),
                           last.p + 0.02 * kMm * vec()});
    if (kind >= 4) poses.emplace_back(scene.start.R, scene.start.p + 0.1 * way_m * vec());
  }
  return poses;
}

class QueryMemoryTest : public testing::TestWithParam<int> {
 protected:
  const Scene& scene = scenes()[static_cast<std::size_t>(GetParam())];
};
INSTANTIATE_TEST_SUITE_P(Scenes, QueryMemoryTest, testing::Range(0, 3));

TEST_P(QueryMemoryTest, SlowMotionIsNoticedAfterAVeryLongJump) {
  QueryMemory memory(scene.map, scene.shell);
  TouchSummary coherent, all;
  const auto ask = [&](const Pose& X_MP) {
    queryWrench(scene.map, scene.shell, X_MP, {}, 1e12, Vec3::Zero(), coherent, &memory);
  };
  ask(scene.start);
  ask({scene.start.R, scene.start.p + Vec3(1e9, 0, 0)});
  // Doubles near 1e9 m, in voxels, are at least 2^-11 apart: 100 nm or more. Steps are 50 nm.
  const Vec3 aside(0.6, 0, 0.8);
  std::set<std::size_t> counts;
  for (int i = 0; i <= 6000; ++i) {
    const Pose X_MP(scene.start.R, scene.start.p + (150 * kUm - i * 0.05 * kUm) * aside);
    ask(X_MP);
    if (i % 100 != 0) continue;
    queryWrench(scene.map, scene.shell, X_MP, {.is_exhaustive = true}, 1e12, Vec3::Zero(), all);
    ASSERT_EQ(coherent.count, all.count) << i;
    ASSERT_EQ(coherent.F_O_M.f, all.F_O_M.f) << i;
    counts.insert(all.count);
  }
  EXPECT_GT(counts.size(), 1u);
}

TEST_P(QueryMemoryTest, ContactsAreThoseOfTheExhaustiveQueryInAnyMotionWithAnyCutoff) {
  const double far_m = 0.9 * scene.map.band_m();
  using Cutoffs = std::vector<double>;  // one pose after the other
  for (const Cutoffs& cutoffs_m :
       {Cutoffs{0}, {30 * kUm}, {far_m}, {0, 10 * kUm, 30 * kUm, 10 * kUm, far_m, 2 * far_m, 0, 0}}) {
    QueryMemory memory(scene.map, scene.shell);
    ContactSet coherent(scene.shell.size()), all(scene.shell.size());
    QueryOptions options;
    std::size_t touching = 0, read = 0, visited = 0, step = 0;
    for (const Pose& X_MP : motion(scene, 600, 5)) {
      const double cutoff_m = options.cutoff_m = cutoffs_m[step++ % cutoffs_m.size()];
      options.is_exhaustive = false;
      const QueryResult a = queryContacts(scene.map, scene.shell, X_MP, options, coherent, &memory);
      options.is_exhaustive = true;
      const QueryResult b = queryContacts(scene.map, scene.shell, X_MP, options, all);
      ASSERT_EQ(coherent.contacts.size(), all.contacts.size()) << scene.name << " cutoff " << cutoff_m;
      for (std::size_t i = 0; i < all.contacts.size(); ++i) {
        const Contact &c = coherent.contacts[i], &e = all.contacts[i];
        ASSERT_TRUE(c.id == e.id && c.distance_m == e.distance_m && c.n_M == e.n_M && c.p_M == e.p_M);
      }
      ASSERT_LE(a.min_distance_m, b.min_distance_m);
      if (!all.contacts.empty()) {
        ASSERT_EQ(a.min_distance_m, b.min_distance_m);
      }
      touching += all.contacts.size();
      read += a.points_tested;
      visited += b.points_tested;
    }
    EXPECT_GT(touching, 100u);
    EXPECT_LT(read, visited);
  }
}

/// A part of the peg's side with `leaves` leaves. A crop keeps the leaves of its points, so each further
/// point adds one leaf or none.
PointShell stretchOf(const PointShell& peg, std::size_t leaves) {
  Box box;
  for (const Vec3& p : peg.points) box.add(p);
  box.min.z() = -4 * kMm;  // apart from the ends, where many points have one height
  std::vector<double> z_m;
  for (const Vec3& p : peg.points)
    if (p.z() >= box.min.z()) z_m.push_back(p.z());
  std::sort(z_m.begin(), z_m.end());
  std::size_t few = 1, many = z_m.size();
  while (few < many) {
    const std::size_t count = (few + many) / 2;
    box.max.z() = 0.5 * (z_m[count - 1] + z_m[count]);
    const PointShell shell = croppedShell(peg, {box});
    if (shell.leaf_blocks == leaves) return shell;
    if (shell.leaf_blocks < leaves)
      few = count + 1;
    else
      many = count;
  }
  return peg;
}

// The leaves have rows of sixteen above them, and the rows groups of sixteen.
TEST(QueryMemory, ServesShellsOfAnyNumberOfLeavesAlsoAfterClear) {
  const Scene& scene = scenes()[0];
  for (const std::size_t leaves : {1, 2, 16, 17, 256, 257}) {
    const PointShell shell = stretchOf(scene.shell, leaves);
    ASSERT_EQ(shell.leaf_blocks, leaves);
    QueryMemory memory(scene.map, shell);
    ContactSet coherent(shell.size()), all(shell.size());
    std::size_t touching = 0, step = 0;
    for (const Pose& X_MP : motion(scene, 300, static_cast<unsigned>(leaves))) {
      if (++step % 50 == 0) memory.clear();
      queryContacts(scene.map, shell, X_MP, {}, coherent, &memory);
      queryContacts(scene.map, shell, X_MP, {.is_exhaustive = true}, all);
      ASSERT_EQ(coherent.contacts.size(), all.contacts.size()) << leaves << " leaves, step " << step;
      for (std::size_t i = 0; i < all.contacts.size(); ++i)
        ASSERT_EQ(coherent.contacts[i].id, all.contacts[i].id) << leaves << " leaves, step " << step;
      touching += all.contacts.size();
    }
    EXPECT_GT(touching, 0u) << leaves;
  }
}

TEST_P(QueryMemoryTest, TheWrenchHasTheSameBitsExhaustiveCulledAndCoherent) {
  for (const Gradient gradient : {Gradient::Trilinear, Gradient::Continuous}) {
    QueryMemory memory(scene.map, scene.shell);
    const Vec3 p_MO(1 * kMm, 2 * kMm, -3 * kMm);
    std::size_t touching = 0;
    for (const Pose& X_MP : motion(scene, 300, 6)) {
      TouchSummary expected, got;
      QueryOptions options;
      options.gradient = gradient;
      options.is_exhaustive = true;
      queryWrench(scene.map, scene.shell, X_MP, options, kStiffness, p_MO, expected);
      const auto expectSame = [&](const char* how) {
        ASSERT_EQ(got.count, expected.count) << how;
        ASSERT_EQ(got.F_O_M.f, expected.F_O_M.f) << how;
        ASSERT_EQ(got.F_O_M.tau, expected.F_O_M.tau) << how;
        ASSERT_EQ(got.area_m2, expected.area_m2) << how;
        ASSERT_EQ(got.volume_m3, expected.volume_m3) << how;
        ASSERT_EQ(got.max_depth_m, expected.max_depth_m) << how;
      };
      options.is_exhaustive = false;
      queryWrench(scene.map, scene.shell, X_MP, options, kStiffness, p_MO, got);
      expectSame("culled");
      queryWrench(scene.map, scene.shell, X_MP, options, kStiffness, p_MO, got, &memory);
      expectSame("coherent");
      touching += expected.count;
    }
    EXPECT_GT(touching, 100u);
  }
}

TEST_P(QueryMemoryTest, TheWrenchIsThePenaltyOfTheContacts) {
  ContactSet set(scene.shell.size());
  const Vec3 p_MO(1 * kMm, 2 * kMm, -3 * kMm);
  for (const Gradient gradient : {Gradient::Trilinear, Gradient::Continuous})
    for (const Pose& X_MP : motion(scene, 60, 7)) {
      QueryOptions options;
      options.gradient = gradient;
      TouchSummary sum;
      queryWrench(scene.map, scene.shell, X_MP, options, kStiffness, p_MO, sum);
      queryContacts(scene.map, scene.shell, X_MP, options, set);
      std::size_t touching = 0;
      double total_N = 0, area_m2 = 0;
      for (const Contact& c : set.contacts) {
        area_m2 += c.area_m2;
        touching += c.distance_m < 0;
        total_N += kStiffness * c.area_m2 * std::max(0.0, -c.distance_m);
      }
      ASSERT_EQ(sum.count, touching);
      const Wrench expected = penaltyWrench(set.contacts, kStiffness, p_MO);
      // Normals and arms are floats: errors of 1e-7 of each force, and some quanta where two normals nearly
      // cancel. Positions are floats of up to 16 voxels from a leaf's base, so depths are accurate to 2e-6
      // voxel.
      const double tol_N = 3e-6 * total_N + kStiffness * area_m2 * 2e-6 * scene.map.voxel_m();
      ASSERT_LE((sum.F_O_M.f - expected.f).norm(), tol_N);
      ASSERT_LE((sum.F_O_M.tau - expected.tau).norm(), tol_N * 20 * kMm);
    }
}

TEST(QueryMemory, AMemoryOfAnotherPairIsNotUsed) {
  // Two pairs that differ only in position: points that are far in one pair touch in the other, at the same
  // pose.
  const Pose moved = Pose::translation({40 * kMm, 0, 0}), X_MP = Pose::translation({30 * kUm, 0, 0});
  const Mesh bore = makeTube(8 * kMm, 5.02 * kMm, 10 * kMm, 64), peg = makeCylinder(5 * kMm, 12 * kMm, 64);
  const VoxMap here = buildVoxMap(bore, {0.25 * kMm, 4}),
               there = buildVoxMap(transformed(bore, moved), {0.25 * kMm, 4});
  const PointShell shell = buildPointShell(peg, {0.15 * kMm, 0.35});
  PointShell away = shell;
  for (Vec3& p : away.points) p.x() += 40 * kMm;
  for (ShellBlock& block : away.blocks) block.center[0] += 40 * kMm;
  struct Pair {
    const VoxMap& map;
    const PointShell& shell;
  };
  TouchSummary expected;
  queryWrench(here, shell, X_MP, {}, kStiffness, Vec3::Zero(), expected);
  ASSERT_GT(expected.count, 100u);
  for (const Pair& other : {Pair{there, shell}, Pair{here, away}}) {
    QueryMemory memory(other.map, other.shell);
    EXPECT_TRUE(memory.isFor(other.map, other.shell));
    EXPECT_FALSE(memory.isFor(here, shell));
    TouchSummary sum;
    queryWrench(other.map, other.shell, X_MP, {}, kStiffness, Vec3::Zero(), sum, &memory);
    EXPECT_EQ(sum.count, 0u);
    queryWrench(here, shell, X_MP, {}, kStiffness, Vec3::Zero(), sum, &memory);
    EXPECT_EQ(sum.count, expected.count);
    EXPECT_EQ(sum.F_O_M.f, expected.F_O_M.f);
    ContactSet contacts(shell.size());
    queryContacts(here, shell, X_MP, {}, contacts, &memory);
    EXPECT_EQ(contacts.contacts.size(), expected.count);
  }
}

TEST(QueryMemory, AtRestOnlyNearPointsAreRead) {
  const Scene& scene = scenes()[0];
  QueryMemory memory(scene.map, scene.shell);
  TouchSummary sum;
  const Pose X_MP = Pose::translation({15 * kUm, 0, 0});  // free: 20 um of clearance
  const QueryResult first =
      queryWrench(scene.map, scene.shell, X_MP, {}, kStiffness, Vec3::Zero(), sum, &memory);
  QueryResult again;
  for (int i = 0; i < 3; ++i)
    again = queryWrench(scene.map, scene.shell, X_MP, {}, kStiffness, Vec3::Zero(), sum, &memory);
  EXPECT_GT(first.points_tested, 1000u);
  // Facets and interpolation leave some leaves within the margin for rounding.
  EXPECT_LT(again.points_tested, first.points_tested / 4);
}

TEST_P(QueryMemoryTest, EveryInstructionSetGivesTheSameBits) {
  constexpr Simd kSets[] = {Simd::Scalar, Simd::Avx2, Simd::Avx512};
  std::vector<QueryMemory> memories;
  for ([[maybe_unused]] const Simd simd : kSets) memories.emplace_back(scene.map, scene.shell);
  std::size_t touching = 0;
  for (const Pose& X_MP : motion(scene, 400, 21))
    for (const Gradient gradient : {Gradient::Continuous, Gradient::Trilinear}) {
      TouchSummary sums[3];
      ContactSet sets[3] = {ContactSet(scene.shell.size()), ContactSet(scene.shell.size()),
                            ContactSet(scene.shell.size())};
      for (std::size_t k = 0; k < 3; ++k) {
        const QueryOptions options{10 * kUm, false, gradient, kSets[k]};
        queryWrench(scene.map, scene.shell, X_MP, options, kStiffness, Vec3::Zero(), sums[k], &memories[k]);
        queryContacts(scene.map, scene.shell, X_MP, options, sets[k], &memories[k]);
        ASSERT_EQ(sums[k].count, sums[0].count);
        ASSERT_EQ(sums[k].volume_m3, sums[0].volume_m3);
        ASSERT_EQ(sums[k].F_O_M.f, sums[0].F_O_M.f);
        ASSERT_EQ(sums[k].F_O_M.tau, sums[0].F_O_M.tau);
        ASSERT_EQ(sets[k].contacts.size(), sets[0].contacts.size());
        for (std::size_t i = 0; i < sets[0].contacts.size(); ++i) {
          const Contact &c = sets[k].contacts[i], &e = sets[0].contacts[i];
          ASSERT_TRUE(c.id == e.id && c.distance_m == e.distance_m && c.n_M == e.n_M && c.p_M == e.p_M);
        }
      }
      touching += sums[0].count;
    }
  EXPECT_GT(touching, 100u);
}

TEST(QueryMemory, NothingAllocates) {
  const Scene& scene = scenes()[0];
  QueryMemory memory(scene.map, scene.shell);
  ContactSet set(scene.shell.size());
  TouchSummary sum;
  const auto poses = motion(scene, 50, 8);
  vps_test::NoAllocScope guard;
  for (const Pose& X_MP : poses) {
    queryContacts(scene.map, scene.shell, X_MP, {}, set, &memory);
    queryWrench(scene.map, scene.shell, X_MP, {}, kStiffness, Vec3::Zero(), sum, &memory);
  }
}

}  // namespace
}  // namespace vps
