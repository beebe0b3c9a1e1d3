// SPDX-License-Identifier: BSD-3-Clause
// The file has more than 400 lines because all tests of the contact query share its helpers.
#include "vps/query.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "support/no_alloc.h"
#include "support/random_draw.h"
#include "vps/mesh_distance.h"

namespace vps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Queries store positions as floats of a few voxels from the leaf, which may be off by 3e-5 voxel.
double readingTolerance(const VoxMap& map) {
  return 1e-4 * map.voxel_m();
}

PointShell shellOf(const Mesh& mesh, double spacing_m) {
  return buildPointShell(mesh, {spacing_m, 0.35});
}

ContactSet contactsOf(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                      const QueryOptions& options = {}) {
  ContactSet set(shell.size());
  EXPECT_EQ(queryContacts(map, shell, X_MP, options, set).status, Status::Ok);
  return set;
}

// ---- Analytic truth ----

TEST(Query, BallOnBallReportsAnalyticDepthAndNormal) {
  const double map_radius_m = 10 * kMm, h = 0.25 * kMm, shell_radius_m = 4 * kMm, sunk_m = 0.2 * kMm;
  const Mesh mesh = makeSphere(map_radius_m, 5);
  const VoxMap map = buildVoxMap(mesh, {h, 4});
  const PointShell shell = shellOf(makeSphere(shell_radius_m, 4), 0.3 * kMm);
  double sagitta_m = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a];
    const Vec3 n = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).normalized();
    sagitta_m = std::max(sagitta_m, map_radius_m - n.dot(p));
  }
  // Error of trilinear interpolation: h^2/8 times the summed second derivatives, 2/r; the facets lie inside
  // the sphere by the sagitta.
  const double tol_m = h * h / (4 * (map_radius_m - map.band_m())) + sagitta_m + map.quantum_m();
  // Facet normals differ from the sphere's by about sqrt(2 sagitta / r); differences over 2h are off by h^2/6
  // of the curvature.
  const double tol_rad = std::sqrt(2 * sagitta_m / map_radius_m) + std::pow(h / map_radius_m, 2);

  const Vec3 direction = Vec3(1, 2, 3).normalized();
  const Pose X_MP(rotationFromVector({0.5, 0.1, 0.2}), (map_radius_m + shell_radius_m - sunk_m) * direction);
  const ContactSet set = contactsOf(map, shell, X_MP);
  ASSERT_GT(set.contacts.size(), 10u);
  double deepest_m = 0;
  for (const Contact& c : set.contacts) {
    EXPECT_NEAR(c.distance_m, c.p_M.norm() - map_radius_m, tol_m);
    EXPECT_LT(c.n_M.cross(c.p_M.normalized()).norm(), tol_rad);
    EXPECT_GT(c.n_M.dot(c.p_M), 0);
    EXPECT_EQ(c.p_M, X_MP * shell.points[c.id]);
    deepest_m = std::max(deepest_m, -c.distance_m);
  }
  // The nearest point is at most a spacing s from the axis, so each ball is s^2/2r short of the whole depth.
  const double s = shell.spacing_m;
  EXPECT_NEAR(deepest_m, sunk_m, tol_m + s * s / 2 * (1 / map_radius_m + 1 / shell_radius_m) + sagitta_m);
}

TEST(Query, BoxSunkInPlateTouchesWithItsWholeLowerFace) {
  const VoxMap map = buildVoxMap(makeBox({20 * kMm, 20 * kMm, 8 * kMm}), {0.25 * kMm, 4});
  const PointShell shell = shellOf(makeBox({6 * kMm, 6 * kMm, 6 * kMm}), 0.5 * kMm);
  const double depth_m = 0.1 * kMm;
  const Pose X_MP = Pose::translation({0.3 * kMm, -0.2 * kMm, 4 * kMm + 3 * kMm - depth_m});
  std::size_t expected = 0;
  for (const Vec3& p : shell.points) expected += (X_MP * p).z() < 4 * kMm;
  const ContactSet set = contactsOf(map, shell, X_MP);
  EXPECT_EQ(set.contacts.size(), expected);
  for (const Contact& c : set.contacts) {  // over a plane trilinear interpolation is exact
    EXPECT_NEAR(c.distance_m, c.p_M.z() - 4 * kMm, map.quantum_m());
    EXPECT_LT((c.n_M - Vec3::UnitZ()).norm(), 1e-5);  // a quantum over 2h
  }
}

TEST(Query, PegInBoreReportsDepthAndNormalWithinHalfAMicron) {
  const double bore_m = 5.01 * kMm, peg_m = 5 * kMm, h = 0.1 * kMm;
  const int segments = 400;
  const VoxMap map = buildVoxMap(makeTube(8 * kMm, bore_m, 10 * kMm, segments), {h, 4});
  const PointShell shell = shellOf(makeCylinder(peg_m, 20 * kMm, segments), 0.5 * kMm);
  const double aside_m = 13 * kUm;  // 10 um of clearance, 3 um deep
  const Pose X_MP = Pose::translation({aside_m, 0, 0});
  // The facets' error is the sagitta, and that of trilinear interpolation is h^2/8 times 1/r, the distance's
  // one second derivative.
  const double sagitta_m = bore_m * (1 - std::cos(std::numbers::pi / segments));
  const double tol_m = sagitta_m + h * h / (8 * (peg_m - map.band_m())) + map.quantum_m();
  ASSERT_LT(tol_m, 0.5 * kUm);
  const double tol_rad = std::numbers::pi / segments + std::pow(h / bore_m, 2);
  const ContactSet set = contactsOf(map, shell, X_MP);
  ASSERT_GT(set.contacts.size(), 20u);
  double deepest_m = 0;
  for (const Contact& c : set.contacts) {
    if (std::abs(c.p_M.z()) > 4.5 * kMm) continue;  // edges are rounded near the bore's rims
    const double rho_m = c.p_M.head<2>().norm();
    EXPECT_NEAR(c.distance_m, bore_m - rho_m, tol_m);
    EXPECT_NEAR(c.n_M.x(), -c.p_M.x() / rho_m, tol_rad);
    EXPECT_NEAR(c.n_M.y(), -c.p_M.y() / rho_m, tol_rad);
    deepest_m = std::max(deepest_m, -c.distance_m);
  }
  EXPECT_NEAR(deepest_m, 3 * kUm, tol_m + 0.1 * kUm);  // and the error of the peg's facets
}

TEST(Query, PenaltyForceOfABallOnAPlateConvergesToTheIntegral) {
  // dA = 2 pi R dz on a sphere, depth falls linearly with z: F = k integral of d dA = k pi R delta^2.
  const double R = 10 * kMm, delta_m = 0.8 * kMm, k = 1e9;
  const VoxMap map = buildVoxMap(makeBox({40 * kMm, 40 * kMm, 10 * kMm}), {0.4 * kMm, 4});
  const Mesh ball = makeSphere(R, 5);
  const double exact_N = k * std::numbers::pi * R * delta_m * delta_m;
  for (const double spacing_m : {0.8 * kMm, 0.4 * kMm, 0.2 * kMm}) {
    const PointShell shell = shellOf(ball, spacing_m);
    const Vec3 center_M(1.1 * kMm, 0.7 * kMm, 5 * kMm + R - delta_m);
    const ContactSet set = contactsOf(map, shell, Pose::translation(center_M));
    const Wrench F = penaltyWrench(set.contacts, k, center_M);
    // A cap of area A = 2 pi R delta has n = A / 0.8 s^2 points. Each point represents a cell whose border is
    // known to the cell's size, so the error of the sum is that of random cells at the rim: s * perimeter of
    // d/2 ~ (s / cap radius)^1.5.
    const double cap_m = std::sqrt(2 * R * delta_m);
    const double tol = std::pow(spacing_m / cap_m, 1.5) + 0.01;  // facets: 2 sagitta / delta
    EXPECT_NEAR(F.f.z() / exact_N, 1, tol) << spacing_m;
    EXPECT_LT(F.f.head<2>().norm() / exact_N, 1e-4);  // error of a plane's normals: a quantum over 2h
    EXPECT_LT(F.tau.norm() / (exact_N * cap_m), tol);
  }
}

TEST(Query, CentralForceHasNoTorqueAboutTheCenterAndTorqueShiftsByTheLever) {
  const Contact contact{Vec3(0, 0, 1), Vec3(0, 0, 1), -2 * kMm, 1e-6, 0, 0};
  const Wrench at_line = penaltyWrench({&contact, 1}, 1e9, Vec3::Zero());
  EXPECT_LT((at_line.f - Vec3(0, 0, 2)).norm(), 1e-12);  // 1e9 * 1e-6 * 2e-3
  EXPECT_LT(at_line.tau.norm(), 1e-12);
  const Vec3 p_MO(3, 0, 0);
  const Wrench off_line = penaltyWrench({&contact, 1}, 1e9, p_MO);
  EXPECT_LT((off_line.tau - Vec3(0, 6, 0)).norm(), 1e-12);  // (0 - p_MO) x f
}

TEST(Query, PointsOutsideGiveNoPenalty) {
  const Contact near{Vec3::Zero(), Vec3::UnitZ(), 1e-5, 1e-6, 0, 0};
  EXPECT_TRUE(penaltyWrench({&near, 1}, 1e9, Vec3::Zero()).f.isZero(0));
  EXPECT_TRUE(penaltyWrench({}, 1e9, Vec3::Zero()).f.isZero(0));
}

// ---- Properties ----

TEST(Query, MovingBothBodiesByOnePoseOnlyRotatesTheWrench) {
  const VoxMap map = buildVoxMap(makeTube(8 * kMm, 5.02 * kMm, 10 * kMm, 64), {0.25 * kMm, 4});
  const PointShell shell = shellOf(makeCylinder(5 * kMm, 12 * kMm, 64), 0.5 * kMm);
  const Pose X_MP(rotationFromVector({0.01, 0.02, 0.3}), Vec3(0.05, 0.02, 1) * kMm);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return test::drawnVector(unit, random); };
  const auto wrenchInWorld = [&](const Pose& X_WM) {
    const Pose X_WP = X_WM * X_MP;
    const ContactSet set = contactsOf(map, shell, X_WM.inverse() * X_WP);
    return rotated(X_WM.R, penaltyWrench(set.contacts, 1e12, X_MP.p));
  };
  const Wrench F_M = wrenchInWorld(Pose());
  ASSERT_GT(F_M.f.norm(), 1);
  for (int i = 0; i < 20; ++i) {
    const Pose X_WM{rotationFromVector(3 * vec()), vec()};
    const Wrench F_W = wrenchInWorld(X_WM);
    // Poses are rounded to 1e-16 of a metre, which is 1e-11 of depths of 1e-5 m, over some hundred points.
    EXPECT_LT((F_W.f - X_WM.R * F_M.f).norm(), 1e-9 * F_M.f.norm());
    EXPECT_LT((F_W.tau - X_WM.R * F_M.tau).norm(), 1e-9 * F_M.f.norm());
  }
}

struct Pair {
  const char* name;
  VoxMap map;
  PointShell shell;
  double size_m;  ///< range of the poses
};

const std::vector<Pair>& pairs() {
  static const std::vector<Pair> all = [] {
    const Mesh bore = makeTube(8 * kMm, 5.02 * kMm, 10 * kMm, 64), peg = makeCylinder(5 * kMm, 12 * kMm, 64);
    const Mesh box = makeBox({6 * kMm, 5 * kMm, 4 * kMm}), block = makeBox({30 * kMm, 30 * kMm, 30 * kMm});
    const Mesh plate = makeBox({10 * kMm, 10 * kMm, 0.3 * kMm}), ball = makeSphere(2 * kMm, 3);
    std::vector<Pair> p;
    p.push_back({"peg in bore", buildVoxMap(bore, {0.25 * kMm, 4}), shellOf(peg, 0.6 * kMm), 10 * kMm});
    p.push_back({"box on itself", buildVoxMap(box, {0.3 * kMm, 3}), shellOf(box, 0.4 * kMm), 5 * kMm});
    p.push_back({"ball in block", buildVoxMap(block, {1 * kMm, 3}), shellOf(ball, 0.3 * kMm), 20 * kMm});
    p.push_back(
        {"ball on thin plate", buildVoxMap(plate, {0.25 * kMm, 3}), shellOf(ball, 0.3 * kMm), 6 * kMm});
    const std::vector<PlacedMesh> parts = {{&box, Pose()}, {&ball, Pose::translation({4 * kMm, 0, 0})}};
    p.push_back(
        {"peg on cooked parts", cookVoxMap(parts, {0.25 * kMm, 4}), shellOf(peg, 0.8 * kMm), 12 * kMm});
    return p;
  }();
  return all;
}

/// Poses of all kinds: free, near, touching, deep. Half of the poses are nearly aligned, so that whole faces
/// are near the cutoff.
std::vector<Pose> manyPoses(const Pair& pair, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return test::drawnVector(unit, random); };
  std::vector<Pose> poses = {Pose()};
  for (int i = 0; i < count; ++i) {
    const bool is_aligned = i % 2 == 0;
    const double tilt_rad = is_aligned ? std::pow(10.0, 3 * unit(random) - 4) : 3.0;
    const double way_m = pair.size_m * std::pow(10.0, -3 + 3.3 * std::abs(unit(random)));
    poses.push_back(Pose{rotationFromVector(tilt_rad * vec()), Vec3(way_m * vec())});
  }
  return poses;
}

class EveryPair : public testing::TestWithParam<int> {
 protected:
  const Pair& pair = pairs()[static_cast<std::size_t>(GetParam())];
};
INSTANTIATE_TEST_SUITE_P(Query, EveryPair, testing::Range(0, 5));

TEST_P(EveryPair, CullingFindsExactlyWhatAnExhaustiveQueryFinds) {
  const double band_m = pair.map.band_m();
  ContactSet culled(pair.shell.size()), all(pair.shell.size());
  std::size_t touching = 0, tested = 0, visited = 0;
  for (const Pose& X_MP : manyPoses(pair, 300))
    for (const double cutoff_m : {0.0, 20 * kUm, -50 * kUm, 0.9 * band_m, 2 * band_m, -2 * band_m}) {
      const QueryResult a =
          queryContacts(pair.map, pair.shell, X_MP, {cutoff_m, false, Gradient::Continuous}, culled);
      const QueryResult b =
          queryContacts(pair.map, pair.shell, X_MP, {cutoff_m, true, Gradient::Continuous}, all);
      ASSERT_EQ(b.points_tested, pair.shell.size());
      ASSERT_EQ(culled.contacts.size(), all.contacts.size()) << pair.name << " cutoff " << cutoff_m;
      for (std::size_t i = 0; i < all.contacts.size(); ++i) {
        const Contact &c = culled.contacts[i], &e = all.contacts[i];
        ASSERT_TRUE(c.id == e.id && c.p_M == e.p_M && c.n_M == e.n_M && c.distance_m == e.distance_m &&
                    c.area_m2 == e.area_m2 && c.owner == e.owner);
        ASSERT_TRUE(i == 0 || all.contacts[i - 1].id < e.id);
        ASSERT_NEAR(e.n_M.norm(), 1, 1e-12);
      }
      // The smallest distance is exact if a point is within the band; otherwise it is a lower bound.
      ASSERT_LE(a.min_distance_m, b.min_distance_m);
      if (!all.contacts.empty()) {
        ASSERT_EQ(a.min_distance_m, b.min_distance_m);
        ASSERT_FALSE(a.is_beyond_band);
      }
      touching += all.contacts.size();
      tested += a.points_tested;
      visited += b.points_tested;
    }
  EXPECT_GT(touching, 1000u);  // the poses do touch
  EXPECT_LT(tested, visited);  // half of the poses are in contact everywhere
}

TEST_P(EveryPair, TheExhaustiveQueryIsTheFieldReadAtEveryPoint) {
  for (const Pose& X_MP : manyPoses(pair, 40)) {
    const ContactSet set = contactsOf(pair.map, pair.shell, X_MP, {20 * kUm, true, Gradient::Trilinear});
    const double tol_m = readingTolerance(pair.map), h = pair.map.voxel_m();
    std::size_t next = 0;
    for (std::uint32_t id = 0; id < pair.shell.size(); ++id) {
      const Vec3 p_M = X_MP * pair.shell.points[id];
      const double distance_m = pair.map.distance(p_M);
      const bool is_listed = next < set.contacts.size() && set.contacts[next].id == id;
      if (std::abs(distance_m - 20 * kUm) > tol_m) {
        ASSERT_EQ(is_listed, distance_m < 20 * kUm);
      }
      if (!is_listed) continue;
      const Contact& c = set.contacts[next++];
      ASSERT_NEAR(c.distance_m, distance_m, tol_m);
      // At a place between nodes of two parts either owner is right.
      if (pair.map.owner(p_M - Vec3::Constant(tol_m)) == pair.map.owner(p_M + Vec3::Constant(tol_m))) {
        ASSERT_EQ(c.owner, pair.map.owner(p_M));
      }
      // Within a cell the trilinear normal turns little over the tolerance; at a cell's face it jumps.
      const Vec3 t = p_M / h;
      if ((t - t.array().round().matrix()).cwiseAbs().minCoeff() * h < tol_m) continue;
      const Vec3 n_M = pair.map.normal(p_M, Gradient::Trilinear);
      ASSERT_LT((c.n_M - (n_M.isZero(0) ? Vec3(X_MP.R * pair.shell.inward[id]) : n_M)).norm(), 0.01);
    }
    ASSERT_EQ(next, set.contacts.size());
  }
}

TEST_P(EveryPair, DistanceIsTheLeastReadingOrALowerBound) {
  std::size_t tested = 0, exact = 0;
  const auto poses = manyPoses(pair, 400);
  for (const Pose& X_MP : poses) {
    double least_m = kInfinity;
    for (const Vec3& p : pair.shell.points) least_m = std::min(least_m, pair.map.distance(X_MP * p));
    const QueryResult result = queryDistance(pair.map, pair.shell, X_MP);
    tested += result.points_tested;
    if (least_m < pair.map.band_m()) {
      if (result.status == Status::BeyondBand) {  // nearly so
        ASSERT_GT(least_m, pair.map.band_m() - readingTolerance(pair.map));
        continue;
      }
      ASSERT_EQ(result.status, Status::Ok);
      ASSERT_NEAR(result.min_distance_m, least_m, readingTolerance(pair.map));
      ++exact;
    } else {
      ASSERT_EQ(result.status, Status::BeyondBand);
      ASSERT_TRUE(result.is_beyond_band);
    }
  }
  EXPECT_GT(exact, 50u);
  EXPECT_LT(tested, poses.size() * pair.shell.size());
}

TEST_P(EveryPair, WhereNothingIsNearTheExhaustiveQueryReadsTheBandAtEveryPoint) {
  // Poses from far away to the rim of the map's directory: groups, rows and leaves are known to be outside.
  const Vec3 aside = Vec3(1, 0.3, 0.2).normalized();
  std::size_t beyond = 0;
  for (double way_m = 0; way_m < 200 * kMm; way_m += 0.7 * kMm) {
    const Pose X_MP(rotationFromVector({0.1, 0.2, 0.3}), way_m * aside);
    double least_m = pair.map.band_m();
    for (const Vec3& p : pair.shell.points) least_m = std::min(least_m, pair.map.distance(X_MP * p));
    ContactSet set(pair.shell.size());
    const QueryResult result = queryContacts(pair.map, pair.shell, X_MP, {0, true}, set);
    ASSERT_EQ(result.points_tested, pair.shell.size());
    ASSERT_NEAR(result.min_distance_m, least_m, readingTolerance(pair.map)) << way_m;
    if (least_m < pair.map.band_m() - readingTolerance(pair.map)) {
      ASSERT_FALSE(result.is_beyond_band) << way_m;
    } else if (result.is_beyond_band) {
      ASSERT_EQ(result.min_distance_m, pair.map.band_m());
      ++beyond;
    }
  }
  EXPECT_GT(beyond, 50u);
}

TEST(Query, OnlyPointsNearContactAreRead) {
  const VoxMap map = buildVoxMap(makeBox({30 * kMm, 30 * kMm, 10 * kMm}), {0.25 * kMm, 4});
  const PointShell shell = shellOf(makeBox({10 * kMm, 10 * kMm, 10 * kMm}), 0.2 * kMm);
  ContactSet set(shell.size());
  // A corner dips 20 um into the plate: down is (1 1 1) of the box, a half diagonal below its centre.
  const Pose X_MP(Quat::FromTwoVectors(Vec3(1, 1, 1), -Vec3::UnitZ()),
                  Vec3(0, 0, 5 * kMm + 5 * std::sqrt(3.0) * kMm - 20 * kUm));
  const QueryResult touching = queryContacts(map, shell, X_MP, {}, set);
  EXPECT_FALSE(set.contacts.empty());
  EXPECT_LT(touching.points_tested, shell.size() / 50);
  EXPECT_LT(queryDistance(map, shell, X_MP).points_tested, shell.size() / 30);
  const QueryResult free = queryContacts(map, shell, Pose::translation({0, 0, 0.1}), {}, set);
  EXPECT_EQ(free.points_tested, 0u);
  EXPECT_TRUE(free.is_beyond_band);
  EXPECT_GT(free.min_distance_m, 0);
}

TEST(Query, FarAwayTheDistanceIsALowerBoundWithASmallError) {
  const Mesh bore = makeTube(8 * kMm, 5.02 * kMm, 10 * kMm, 64);
  const VoxMap map = buildVoxMap(bore, {0.25 * kMm, 4});
  const PointShell shell = shellOf(makeCylinder(5 * kMm, 12 * kMm, 64), 0.6 * kMm);
  const MeshDistance exact(bore);
  for (const double z_m : {13 * kMm, 15 * kMm, 40 * kMm, 1.0, 1e6}) {
    const Pose X_MP = Pose::translation({1 * kMm, 0, z_m});
    double true_m = kInfinity;
    for (const Vec3& p : shell.points) true_m = std::min(true_m, exact.closest(X_MP * p).distance_m);
    const QueryResult result = queryDistance(map, shell, X_MP);
    EXPECT_LE(result.min_distance_m, true_m) << z_m;
    EXPECT_GT(result.min_distance_m, 0.5 * true_m) << z_m;
    EXPECT_LT(result.points_tested, shell.size() / 5);
  }
}

// ---- Limits of the contract ----

TEST(Query, AFullContactSetKeepsTheFirstIdsAndCountsTheRest) {
  const Pair& pair = pairs()[1];
  ContactSet all(pair.shell.size()), few(10);
  ASSERT_EQ(queryContacts(pair.map, pair.shell, Pose(), {10 * kUm}, all).status, Status::Ok);
  ASSERT_GT(all.contacts.size(), 10u);
  EXPECT_EQ(queryContacts(pair.map, pair.shell, Pose(), {10 * kUm}, few).status, Status::Truncated);
  ASSERT_EQ(few.contacts.size(), 10u);
  EXPECT_EQ(few.contacts.size() + few.left_out, all.contacts.size());
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(few.contacts[i].id, all.contacts[i].id);
  // The next query starts from an empty set.
  EXPECT_EQ(queryContacts(pair.map, pair.shell, Pose::translation({1, 0, 0}), {}, few).status, Status::Ok);
  EXPECT_TRUE(few.contacts.empty());
  EXPECT_EQ(few.left_out, 0u);
}

TEST(Query, ABadPoseGivesNoContacts) {
  const Pair& pair = pairs()[0];
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    Pose moved, turned;
    moved.p.z() = bad;
    turned.R(0, 1) = bad;
    for (const Pose& X_MP : {moved, turned}) {
      ContactSet set(100);
      ASSERT_EQ(queryContacts(pair.map, pair.shell, Pose(), {1 * kMm}, set).status, Status::Truncated);
      EXPECT_EQ(queryContacts(pair.map, pair.shell, X_MP, {1 * kMm}, set).status, Status::BadPose);
      EXPECT_TRUE(set.contacts.empty());
      EXPECT_EQ(set.left_out, 0u);
      EXPECT_EQ(queryDistance(pair.map, pair.shell, X_MP).status, Status::BadPose);
    }
  }
}

TEST(Query, AnEmptyShellTouchesNothing) {
  ContactSet set(4);
  const QueryResult result = queryContacts(pairs()[0].map, PointShell{}, Pose(), {}, set);
  EXPECT_EQ(result.status, Status::Ok);
  EXPECT_TRUE(set.contacts.empty());
  EXPECT_EQ(result.min_distance_m, kInfinity);
  EXPECT_EQ(queryDistance(pairs()[0].map, PointShell{}, Pose()).min_distance_m, kInfinity);
}

TEST(Query, DeeperThanTheBandThePointsOwnNormalIsUsed) {
  const Pair& pair =
      pairs()[2];  // a ball in the middle of a block, 15 mm of material around it, 3 mm of band
  const ContactSet set = contactsOf(pair.map, pair.shell, Pose());
  ASSERT_EQ(set.contacts.size(), pair.shell.size());
  for (const Contact& c : set.contacts) {
    EXPECT_EQ(c.distance_m, -pair.map.band_m());
    EXPECT_EQ(c.n_M, pair.shell.inward[c.id]);
  }
}

TEST(Query, OwnersDistinguishMountedParts) {
  const Pair& pair = pairs()[4];
  const PointShell& ball = pairs()[2].shell;
  // First near the ball at x = 4 mm from its far side, then near the box from the other side.
  const ContactSet on_ball = contactsOf(pair.map, ball, Pose::translation({7.95 * kMm, 0, 0}));
  ASSERT_FALSE(on_ball.contacts.empty());
  for (const Contact& c : on_ball.contacts) EXPECT_EQ(c.owner, 1);
  const ContactSet on_box = contactsOf(pair.map, ball, Pose::translation({-4.95 * kMm, 0, 0}));
  ASSERT_FALSE(on_box.contacts.empty());
  for (const Contact& c : on_box.contacts) EXPECT_EQ(c.owner, 0);
}

TEST(Query, NothingAllocates) {
  const Pair& pair = pairs()[0];
  ContactSet set(500);
  double sum = 0;
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 50; ++i) {
    const Pose X_MP = Pose::translation({i * 5 * kUm, 0, 0});
    static_cast<void>(queryContacts(pair.map, pair.shell, X_MP, {10 * kUm}, set));
    sum += queryDistance(pair.map, pair.shell, X_MP).min_distance_m;
    sum += penaltyWrench(set.contacts, 1e12, Vec3::Zero()).f.norm();
  }
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace vps
