// SPDX-License-Identifier: BSD-3-Clause
#include "vps/pointshell.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "vps/errors.h"
#include "vps/mesh_distance.h"

namespace vps {
namespace {

constexpr double kRounding = 1e-15;  // of coordinates of a few centimetres

double nearestDistance(const Vec3& p, const std::vector<Vec3>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : points) least = std::min(least, (p - q).squaredNorm());
  return std::sqrt(least);
}

/// Uniform random points on a mesh.
std::vector<Vec3> probes(const Mesh& mesh, int count) {
  std::vector<double> cumulative;
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a];
    cumulative.push_back(sum += (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm());
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), unit(random) * sum);
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(found - cumulative.begin())];
    const double s = std::sqrt(unit(random)), u = unit(random);
    points.push_back((1 - s) * mesh.vertices[a] + s * (1 - u) * mesh.vertices[b] + s * u * mesh.vertices[c]);
  }
  return points;
}

/// A mesh and a spacing; shells are built once for all tests.
struct Sample {
  const char* name;
  Mesh mesh;
  double spacing_m;
  PointShell shell;
};

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = [] {
    std::vector<Sample> s;
    s.push_back({"box", makeBox({20 * kMm, 10 * kMm, 6 * kMm}), 0.5 * kMm, {}});
    s.push_back({"peg", makeCylinder(5 * kMm, 20 * kMm, 160), 0.5 * kMm, {}});
    s.push_back({"bushing", makeTube(6 * kMm, 5 * kMm, 10 * kMm, 200), 0.5 * kMm, {}});
    s.push_back({"ball", makeSphere(4 * kMm, 4), 0.4 * kMm, {}});
    s.push_back({"thin plate", makeBox({10 * kMm, 10 * kMm, 0.1 * kMm}), 0.5 * kMm, {}});
    s.push_back({"grain", makeBox({0.1 * kMm, 0.1 * kMm, 0.1 * kMm}), 0.5 * kMm, {}});
    for (Sample& sample : s) sample.shell = buildPointShell(sample.mesh, {sample.spacing_m, 0.35});
    return s;
  }();
  return all;
}

class EveryShell : public testing::TestWithParam<int> {
 protected:
  const Sample& sample = samples()[static_cast<std::size_t>(GetParam())];
  const PointShell& shell = sample.shell;
};
INSTANTIATE_TEST_SUITE_P(PointShell, EveryShell, testing::Range(0, 6), [](const auto& info) {
  std::string name = samples()[static_cast<std::size_t>(info.param)].name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_P(EveryShell, PointsLieOnTheMeshWithUnitInwardNormals) {
  const MeshDistance exact(sample.mesh);
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const MeshDistance::Closest closest = exact.closest(shell.points[i]);
    ASSERT_LT(closest.distance_m, 10 * kRounding);
    ASSERT_NEAR(shell.inward[i].norm(), 1, 1e-14);
    // Rounding may assign a point near a border of facets to either facet, and these are at most 20 degrees
    // apart. On sharp edges of right angles the pseudonormal is at most acos(1/sqrt 3) from a face's normal.
    ASSERT_LT(shell.inward[i].dot(closest.normal), -0.55);
  }
}

TEST_P(EveryShell, AreasSumToTheMeshsArea) {
  const double sum = std::accumulate(shell.area_m2.begin(), shell.area_m2.end(), 0.0);
  EXPECT_NEAR(sum / area(sample.mesh), 1, 1e-10);  // some 1e5 additions
  for (const double a : shell.area_m2) ASSERT_GE(a, 0);
}

TEST_P(EveryShell, NoSurfacePointIsFartherThanTheSpacingFromAShellPoint) {
  double greatest = 0;
  for (const Vec3& p : probes(sample.mesh, 5000))
    greatest = std::max(greatest, nearestDistance(p, shell.points));
  EXPECT_LE(greatest, sample.spacing_m);
  RecordProperty("greatest_gap_over_spacing", std::to_string(greatest / sample.spacing_m));
}

TEST_P(EveryShell, SpheresContainTheirPointsAndSkipTheirNodes) {
  std::size_t next_point = 0;
  for (std::size_t i = 0; i < shell.nodes.size(); ++i) {
    const ShellNode& node = shell.nodes[i];
    ASSERT_GT(node.skip, i);
    ASSERT_LE(node.skip, shell.nodes.size());
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
      ASSERT_LE((shell.points[k] - node.center).norm(), node.radius_m);
    if (node.is_leaf) {
      ASSERT_EQ(node.skip, i + 1);
      ASSERT_EQ(node.first, next_point);
      ASSERT_LE(node.count, 16u);
      next_point += node.count;
    } else {  // two children that share the range
      const ShellNode &left = shell.nodes[i + 1], &right = shell.nodes[left.skip];
      ASSERT_EQ(left.first, node.first);
      ASSERT_EQ(right.first, node.first + left.count);
      ASSERT_EQ(left.count + right.count, node.count);
      ASSERT_EQ(right.skip, node.skip);
    }
  }
  EXPECT_EQ(next_point, shell.size());
}

TEST_P(EveryShell, EveryPrefixOfTheOrderIsAnEvenSampling) {
  std::vector<std::uint32_t> sorted = shell.order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);  // a permutation

  for (std::size_t count = 4; count < shell.size() / 4; count *= 3) {
    std::vector<Vec3> prefix;
    double least_gap_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      least_gap_m = std::min(least_gap_m, nearestDistance(shell.points[shell.order[k]], prefix));
      prefix.push_back(shell.points[shell.order[k]]);
    }
    double cover_m = 0;
    for (const Vec3& p : shell.points) cover_m = std::max(cover_m, nearestDistance(p, prefix));
    EXPECT_LE(cover_m, 2 * least_gap_m) << count;  // radii halve from level to level
  }
}

TEST(PointShell, FacePointsKeepThreeQuartersOfTheSpacingFromEachOther) {
  const Sample& peg = samples()[1];
  std::vector<Vec3> wall;
  for (const Vec3& p : peg.shell.points)
    if (std::abs(p.z()) < 10 * kMm - kRounding) wall.push_back(p);
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const Vec3 p = wall[i];
    wall[i] = Vec3::Constant(1);  // not its own neighbour
    const double gap = nearestDistance(p, wall);
    wall[i] = p;
    least = std::min(least, gap);
    sum += gap;
  }
  EXPECT_GE(least, 0.75 * peg.spacing_m - kRounding);
  EXPECT_LT(sum / static_cast<double>(wall.size()), peg.spacing_m);
}

TEST(PointShell, CornersAndRimVerticesAreKept) {
  // The vertices of convex rims touch first. 160 segments of a 5 mm circle are 0.196 mm long; leaving out a
  // vertex moves the rim by 3.9 um, more than the tolerance of 1 um.
  for (const std::size_t which : {0, 1, 2, 5})
    for (const Vec3& vertex : samples()[which].mesh.vertices) {
      if (vertex.head<2>().norm() < kRounding) continue;  // a fan's centre on the peg's end is flat
      EXPECT_LE(nearestDistance(vertex, samples()[which].shell.points), 0) << samples()[which].name;
    }
}

TEST(PointShell, SharpEdgesAreSampledEvenlyAtHalfTheSpacing) {
  const Sample& box = samples()[0];
  std::vector<double> along;
  for (const Vec3& p : box.shell.points)
    if (std::abs(p.y() - 5 * kMm) < kRounding && std::abs(p.z() - 3 * kMm) < kRounding)
      along.push_back(p.x());
  std::sort(along.begin(), along.end());
  ASSERT_EQ(along.size(), 81u);  // 20 mm / 0.25 mm, both ends
  for (std::size_t i = 1; i < along.size(); ++i) EXPECT_NEAR(along[i] - along[i - 1], 0.25 * kMm, 1e-15);
}

TEST(PointShell, AFinerTessellationDoesNotCrowdTheRim) {
  const double spacing_m = 0.5 * kMm;
  const PointShell shell = buildPointShell(makeCylinder(5 * kMm, 5 * kMm, 2000), {spacing_m, 0.35});
  const auto on_rim =
      static_cast<double>(std::count_if(shell.points.begin(), shell.points.end(), [](const Vec3& p) {
        return p.z() > 2.5 * kMm - kRounding && p.head<2>().norm() > 5 * kMm - 1e-12;
      }));
  // A chord of c moves the rim by c^2 / 8r: 1 um allows 0.2 mm, so about 157 points instead of 2000.
  EXPECT_LT(on_rim, 2 * std::numbers::pi * 5 / 0.2 * 1.2);
  EXPECT_GE(on_rim, 2 * std::numbers::pi * 5 / 0.25);
}

/// A plate of 12 mm with a smooth bump on its upper side: a raised cosine.
Mesh plateWithBump(const Vec3& at, double width_m, double height_m) {
  constexpr int kCells = 240;  // of 50 um
  constexpr double kSide_m = 12 * kMm;
  Mesh mesh = makeBox({kSide_m, kSide_m, 2 * kMm});
  std::erase_if(mesh.triangles, [&](const auto& t) {  // the upper side is replaced
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.vertices[v].z() > 0; });
  });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      Vec3 p(kSide_m * i / kCells - kSide_m / 2, kSide_m * j / kCells - kSide_m / 2, kMm);
      const double share = 2 * (p - at).head<2>().norm() / width_m;
      if (share < 1) p.z() += height_m * 0.5 * (1 + std::cos(std::numbers::pi * share));
      mesh.vertices.push_back(p);
    }
  const auto id = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (kCells + 1) + i); };
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return mesh;
}

// Without points of their own, bumps narrower than the spacing mostly lie between all points. A point whose
// normal leans by 20 degrees from the top's is lower than the top by 1 - cos 20 degrees of the radius.
TEST(PointShell, ASmoothBumpSmallerThanTheSpacingHasPointsNearItsTop) {
  constexpr double kSpacing_m = kMm, kHeight_m = 0.2 * kMm;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-4 * kMm, 4 * kMm);
  const std::size_t flat = buildPointShell(plateWithBump(Vec3::Zero(), 1 * kMm, 0), {kSpacing_m}).size();
  for (const double width_m : {0.6 * kMm, 1 * kMm, 1.4 * kMm})
    for (int i = 0; i < 4; ++i) {
      const Mesh mesh = plateWithBump({place(random), place(random), 0}, width_m, kHeight_m);
      const PointShell shell = buildPointShell(mesh, {kSpacing_m});
      const double radius_m = width_m * width_m / (2 * std::numbers::pi * std::numbers::pi * kHeight_m);
      double top_m = 0, highest_m = 0;
      for (const Vec3& v : mesh.vertices) top_m = std::max(top_m, v.z());
      for (const Vec3& p : shell.points) highest_m = std::max(highest_m, p.z());
      EXPECT_LE(top_m - highest_m, (1 - 0.94) * radius_m + 0.01 * kSpacing_m) << width_m << " " << i;
      EXPECT_LT(shell.size(), flat + 100) << width_m << " " << i;
    }
}

// A surface that curves evenly, convex or hollow, needs no more points.
TEST(PointShell, EvenCurvatureIsNoBump) {
  Mesh bore = makeCylinder(4 * kMm, 10 * kMm, 400);
  for (auto& t : bore.triangles) std::swap(t[0], t[1]);
  for (const Mesh& mesh : {makeCylinder(4 * kMm, 10 * kMm, 400), bore, makeSphere(4 * kMm, 5)}) {
    const PointShell shell = buildPointShell(mesh, {0.5 * kMm});
    for (std::size_t i = 0; i < shell.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const bool is_on_rim = std::abs(std::abs(shell.points[i].z()) - 5 * kMm) < 0.5 * kMm ||
                               std::abs(std::abs(shell.points[j].z()) - 5 * kMm) < 0.5 * kMm;
        if (is_on_rim || shell.inward[i].dot(shell.inward[j]) <= 0) continue;
        ASSERT_GT((shell.points[i] - shell.points[j]).norm(), 0.7499 * 0.5 * kMm) << i << " " << j;
      }
  }
}

TEST(PointShell, BothSidesOfAThinPlateAreSampled) {
  const Sample& plate = samples()[4];
  std::vector<Vec3> top, bottom;
  for (std::size_t i = 0; i < plate.shell.size(); ++i)
    (plate.shell.inward[i].z() < 0 ? top : bottom).push_back(plate.shell.points[i]);
  for (const Vec3& p : probes(plate.mesh, 2000)) {
    if (std::abs(std::abs(p.z()) - 0.05 * kMm) > kRounding) continue;
    EXPECT_LE(nearestDistance(p, p.z() > 0 ? top : bottom), plate.spacing_m);
  }
}

TEST(PointShell, TwoBuildsAreTheSameToTheBit) {
  for (const Sample& sample : samples()) {
    const PointShell again = buildPointShell(sample.mesh, {sample.spacing_m, 0.35});
    EXPECT_EQ(again.points, sample.shell.points);
    EXPECT_EQ(again.inward, sample.shell.inward);
    EXPECT_EQ(again.area_m2, sample.shell.area_m2);
    EXPECT_EQ(again.order, sample.shell.order);
  }
}

TEST(PointShell, AMeshWithRepeatedVerticesGivesTheSameShell) {
  const Mesh box = samples()[0].mesh;
  Mesh soup;
  for (const auto& triangle : box.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : triangle) soup.vertices.push_back(box.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(buildPointShell(soup, {0.5 * kMm, 0.35}).size(), samples()[0].shell.size());
}

TEST(PointShell, MergingKeepsTheOrderSoThatIdsMapBack) {
  const PointShell &a = samples()[5].shell, &b = samples()[3].shell;
  const Pose X_MA(rotationFromVector({0.3, 0.2, 0.1}), Vec3(1, 2, 3) * kMm),
      X_MB = Pose::translation({0.02, 0, 0});
  const PointShell merged = mergedShells({&a, &b}, {X_MA, X_MB});
  ASSERT_EQ(merged.size(), a.size() + b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(merged.points[i], X_MA * a.points[i]);
  for (std::size_t i = 0; i < b.size(); ++i) {
    EXPECT_EQ(merged.points[a.size() + i], X_MB * b.points[i]);
    EXPECT_EQ(merged.inward[a.size() + i], b.inward[i]);
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < merged.nodes.size(); ++i) {
    const ShellNode& node = merged.nodes[i];
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
      ASSERT_LE((merged.points[k] - node.center).norm(), node.radius_m);
    if (node.is_leaf) {
      ASSERT_EQ(node.first, next);
      next += node.count;
    }
  }
  EXPECT_EQ(next, merged.size());
  EXPECT_EQ(merged.nodes.front().skip, merged.nodes.size());
  EXPECT_EQ(mergedShells({}, {}).size(), 0u);
}

TEST(PointShell, UnusableInputIsRefusedAndTheRemedyNamed) {
  const Mesh box = makeBox({1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double spacing_m : {0.0, -1.0, nan, inf})
    EXPECT_THROW(static_cast<void>(buildPointShell(box, {spacing_m, 0.35}, "hub")), LoadError);
  EXPECT_THROW(static_cast<void>(buildPointShell(box, {0.1, nan}, "hub")), LoadError);
  EXPECT_THROW(static_cast<void>(buildPointShell(Mesh{}, {0.1, 0.35}, "hub")), LoadError);
  Mesh bad = box;
  bad.vertices[0].x() = nan;
  EXPECT_THROW(static_cast<void>(buildPointShell(bad, {0.1, 0.35}, "hub")), LoadError);

  const auto messageOf = [](const Mesh& mesh, double spacing_m) -> std::string {
    try {
      static_cast<void>(buildPointShell(mesh, {spacing_m, 0.35}, "hub"));
    } catch (const LoadError& error) {
      return error.what();
    }
    return "accepted";
  };
  // A cubic metre at 0.5 mm: 6 / 0.25e-6 * 1.3 = 31.2 million points, and 0.5 sqrt(31.2 / 16) = 0.6982.
  EXPECT_NE(messageOf(box, 0.5 * kMm).find("699 um is fine enough"), std::string::npos)
      << messageOf(box, 0.5 * kMm);
  EXPECT_NE(messageOf(box, 0.5 * kMm).find("part 'hub'"), std::string::npos);
  // A needle has little area but long edges.
  EXPECT_NE(messageOf(makeBox({1e6, 1e-9, 1e-9}), 0.5 * kMm).find("too many points"), std::string::npos);
}

}  // namespace
}  // namespace vps
