// SPDX-License-Identifier: BSD-3-Clause
// Solid and voxmap agree with the truth about "inside", on every kind of faulty mesh.
#include "vps/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "support/analytic.h"
#include "support/faulty_meshes.h"
#include "vps/mesh_repair.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"
#include "vps/winding_number.h"

namespace vps::test {
namespace {

constexpr VoxMapSettings kVoxels = {0.5e-3, 4};

/// Number of points for each mesh; VPS_SOLID_POINTS=100000 takes minutes.
int pointCount() {
  const char* given = std::getenv("VPS_SOLID_POINTS");
  return given != nullptr ? std::atoi(given) : 3000;
}

/// A third of the points anywhere in and around the part, a third within some voxels of the surface, and a
/// third 0.01 to 300 um from facets' edges and corners, where signs are difficult.
class Probes {
 public:
  explicit Probes(const Mesh& mesh) : mesh_(mesh) {}

  Vec3 next() {
    if (++count_ % 3 == 0) return bounds(mesh_).center() + random_.inBox(0.6 * bounds(mesh_).size());
    const auto pick = static_cast<std::size_t>((0.5 + 0.5 * random_.unit()) * 0.999999 *
                                               static_cast<double>(mesh_.triangles.size()));
    const auto& t = mesh_.triangles[pick];
    const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    const double u = 0.5 + 0.5 * random_.unit(), v = (0.5 + 0.5 * random_.unit()) * (1 - u);
    if (count_ % 3 == 1) return a + u * (b - a) + v * (c - a) + random_.inBox(Vec3::Constant(2e-3));
    const Vec3 q = count_ % 2 == 0 ? Vec3(a + u * (b - a)) : a;
    const Vec3 way = random_.inBox(Vec3::Ones()).normalized();
    return q + std::pow(10, -5.75 + 2.25 * random_.unit()) * way;
  }

 private:
  const Mesh& mesh_;
  RandomPoints random_{31};
  int count_ = 0;
};

/// True if the sign changes without a surface between p and a corner of its cell: the sum of their distances
/// from the surface exceeds the distance between them. The middle of a hole then lies between p and the
/// corner, and a field between nodes of both signs has no meaning in a hole.
bool isInHole(const Solid& solid, double exact_m, const VoxMap& map, const Pose& X_MP, const Vec3& p,
              double crack_m) {
  const double h = map.voxel_m();
  const Vec3 low = h * ((X_MP * p) / h).array().floor().matrix();
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner = X_MP.inverse() * (low + h * Vec3(k & 1, k >> 1 & 1, k >> 2));
    const double corner_m = solid.signedDistance(corner);
    if ((corner_m < 0) != (exact_m < 0) &&
        std::abs(corner_m) + std::abs(exact_m) > (corner - p).norm() * (1 + 1e-9) + crack_m)
      return true;
  }
  return false;
}

class SolidOfFaultyMesh : public testing::TestWithParam<FaultyMesh> {};

TEST_P(SolidOfFaultyMesh, AgreesWithTheTruth) {
  const FaultyMesh& faulty = GetParam();
  const Solid solid(faulty.mesh);
  Probes probes(faulty.mesh);
  std::size_t wrong = 0, off = 0, claimed = 0;
  double worst_m = 0;
  // Distances are some operations on coordinates of 20 mm.
  const double error_m = faulty.error_m + 1e-14;
  const int count = pointCount();
  for (int n = 0; n < count; ++n) {
    const Vec3 p = probes.next();
    if (faulty.isByHole && faulty.isByHole(p)) continue;
    const double truth_m = faulty.truth(p), d = solid.signedDistance(p);
    ASSERT_EQ(d < 0, solid.isInside(p) && d != 0) << p.transpose();
    if (std::abs(truth_m) <= error_m) continue;
    ++claimed;
    wrong += (d < 0) != (truth_m < 0);
    // Overlapping shells that are not united keep facets that lie partly in each other; inside, such facets
    // are nearer.
    if (truth_m < 0 && faulty.is_union) continue;
    worst_m = std::max(worst_m, std::abs(d - truth_m));
    off += std::abs(d - truth_m) > error_m;
  }
  std::printf("%-45s solid against truth: %zu points, %zu wrong signs, %zu distances off, worst %.3g um\n",
              faulty.fault.c_str(), claimed, wrong, off, 1e6 * worst_m);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(off, 0u);
  EXPECT_GT(claimed, static_cast<std::size_t>(count) / 3);
}

TEST_P(SolidOfFaultyMesh, AgreesWithAllFacetsWindingNumber) {
  const FaultyMesh& faulty = GetParam();
  const Solid solid(faulty.mesh);
  const RepairedMesh repaired = repairMesh(welded(faulty.mesh));
  const WindingNumber winding(repaired.solid);
  Probes probes(faulty.mesh);
  std::size_t wrong = 0;
  const int count = std::min(pointCount(), 100000000 / static_cast<int>(repaired.solid.triangles.size()));
  for (int n = 0; n < count; ++n) {
    const Vec3 p = probes.next();
    const double w = winding.exact(p);
    const Solid::Closest closest = solid.closest(p);
    // In the middle of a hole, and within rounding of a facet, the winding number does not decide.
    if (std::abs(w - 0.5) < 0.02 || closest.distance_m < 1e-12) continue;
    const Box box = bounds(repaired.surface);
    const bool may = (p.array() > box.min.array()).all() && (p.array() < box.max.array()).all();
    wrong += solid.isInside(p) != (may && w > 0.5);
    // The normal has the sign of the distance.
    wrong += (closest.normal.dot(p - closest.q) < 0) != (may && w > 0.5);
  }
  EXPECT_EQ(wrong, 0u);
}

TEST_P(SolidOfFaultyMesh, AgreesWithItsVoxmapWithinTheMapsError) {
  const FaultyMesh& faulty = GetParam();
  const Solid solid(faulty.mesh);
  for (const bool is_placed : {false, true}) {
    // A placed solid is voxelised on another grid; points of its own frame move with it.
    const Pose X_MP = is_placed ? RandomPoints(5).pose(0.01) : Pose();
    const VoxMap map = buildVoxMap(PlacedSolid{&solid, X_MP}, kVoxels);
    Probes probes(faulty.mesh);
    std::size_t wrong = 0, off = 0, in_holes = 0;
    double worst_m = 0;
    const int count = pointCount();
    for (int n = 0; n < count; ++n) {
      const Vec3 p = probes.next();
      const double exact_m = solid.signedDistance(p), field_m = map.distance(X_MP * p);
      const double held_m = std::clamp(exact_m, -map.band_m(), map.band_m());
      const double error_m = map.sampleError_m();
      const bool is_wrong = std::abs(exact_m) > error_m && (field_m < 0) != (exact_m < 0);
      const bool is_off = std::abs(field_m - held_m) > error_m;
      if ((is_wrong || is_off) && isInHole(solid, exact_m, map, X_MP, p, 2 * faulty.error_m)) {
        ++in_holes;
        continue;
      }
      wrong += is_wrong;
      off += is_off;
      worst_m = std::max(worst_m, std::abs(field_m - held_m));
    }
    std::printf(
        "%-45s field against solid: %zu wrong signs, %zu off by more than %.0f um, worst %.0f um, %zu in "
        "holes\n",
        faulty.fault.c_str(), wrong, off, 1e6 * map.sampleError_m(), 1e6 * worst_m, in_holes);
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(off, 0u);
    EXPECT_LE(in_holes, faulty.isByHole ? static_cast<std::size_t>(count) / 5 : 0u);
  }
}

TEST_P(SolidOfFaultyMesh, HasAShellWhoseNormalsPointIn) {
  const FaultyMesh& faulty = GetParam();
  const Solid solid(faulty.mesh);
  const PointShell shell = buildPointShell(solid, {1e-3, 0.35});
  ASSERT_GT(shell.size(), 100u);
  const double off_m = 20e-6 + 2 * faulty.error_m;
  std::size_t reversed = 0;
  for (std::size_t i = 0; i < shell.size(); ++i) {
    // At an edge of four facets the mean of their normals has no meaning.
    const auto& t = solid.mesh().triangles[solid.closest(shell.points[i]).triangle];
    bool is_on_edge = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = solid.mesh().vertices[t[k]], &b = solid.mesh().vertices[t[(k + 1) % 3]];
      is_on_edge |= (shell.points[i] - a).cross(b - a).norm() < 1e-6 * (b - a).norm();
    }
    if (is_on_edge) continue;
    const Vec3 step = off_m * shell.inward[i];
    reversed += faulty.truth(shell.points[i] - step) < 0 && faulty.truth(shell.points[i] + step) > 0;
  }
  EXPECT_EQ(reversed, 0u);
}

INSTANTIATE_TEST_SUITE_P(Of, SolidOfFaultyMesh, testing::ValuesIn(faultyMeshes()), [](const auto& info) {
  std::string name;
  for (const char c : info.param.fault) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(Solid, ThereAreAtLeastTwentyKindsOfFaultyMesh) {
  EXPECT_GE(faultyMeshes().size(), 22u);  // two of these meshes are closed
}

}  // namespace
}  // namespace vps::test
