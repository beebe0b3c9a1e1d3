// SPDX-License-Identifier: BSD-3-Clause
// The overlap judge on faulty meshes: its depths agree with the true ones, and with those of the voxmaps
// within their error.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>

#include "judge/overlap_judge.h"
#include "support/faulty_meshes.h"

namespace vps::scenes {
namespace {

using test::FaultyMesh;

constexpr double kVoxel_m = 0.5e-3;
/// The probe is a small cube, whose depth is that of its middle to within half its diagonal.
constexpr double kProbe_m = 20e-6;
constexpr double kReach_m = 0.8660254 * kProbe_m;

JudgedBody makeBody(const Mesh& mesh, double spacing_m) {
  return makeJudgedBody(buildPartModel("", mesh, {kVoxel_m, 4}, {spacing_m, 0.35}));
}

class JudgeOfFaultyMesh : public testing::TestWithParam<FaultyMesh> {
 protected:
  void SetUp() override { judge_.mount(makeBody(GetParam().mesh, 1e-3), {}); }
  JudgedBody probe_ = makeBody(makeBox(Vec3::Constant(kProbe_m)), kProbe_m);
  OverlapJudge judge_;
};

TEST_P(JudgeOfFaultyMesh, AProbeIsAsDeepAsTheTruthSays) {
  const FaultyMesh& faulty = GetParam();
  test::RandomPoints random(41);
  const Mesh& mesh = faulty.mesh;
  int wrong = 0, deep = 0, free = 0;
  double worst_m = 0;
  for (int n = 0; n < 300; ++n) {
    // The poses are near an edge of the mesh, where the cracks are.
    const auto& t = mesh.triangles[static_cast<std::size_t>(n) * 7919 % mesh.triangles.size()];
    const double share = 0.5 + 0.5 * random.unit();
    const Vec3 p = mesh.vertices[t[0]] + share * (mesh.vertices[t[1]] - mesh.vertices[t[0]]) +
                   random.inBox(Vec3::Constant(0.2e-3));
    if (faulty.isByHole && faulty.isByHole(p)) continue;
    const double true_m = std::max(0.0, -faulty.truth(p));
    const Pose X_WP(random.pose(0).R, p);
    const double judged_m = judge_.deepest(probe_, X_WP).depth_m, field_m = judge_.fieldDepth_m(probe_, X_WP);
    // For a union only the sign of the truth is known; overlapping shells may be nearer than their union.
    const double error_m = kReach_m + faulty.error_m;
    const bool is_wrong =
        faulty.is_union ? (true_m == 0 ? judged_m > error_m : false) : std::abs(judged_m - true_m) > error_m;
    wrong += is_wrong;
    worst_m = std::max(worst_m, faulty.is_union ? 0 : std::abs(judged_m - true_m));
    // The field's error is 0.87 voxels; the probe's points and edges are at most its size apart.
    const double held_m = std::min(judged_m, 4 * kVoxel_m);  // the field saturates beyond its band
    wrong += std::abs(held_m - field_m) > 0.87 * kVoxel_m + 2 * kReach_m;
    (true_m > 0 ? deep : free) += 1;
  }
  std::printf("%-45s judge: %d poses deep, %d free, %d wrong, worst difference from the truth %.2f um\n",
              faulty.fault.c_str(), deep, free, wrong, 1e6 * worst_m);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(free, 30);
  EXPECT_GT(deep, 15);
}

INSTANTIATE_TEST_SUITE_P(Of, JudgeOfFaultyMesh, testing::ValuesIn(test::faultyMeshes()),
                         [](const auto& info) {
                           std::string name;
                           for (const char c : info.param.fault)
                             name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace vps::scenes
