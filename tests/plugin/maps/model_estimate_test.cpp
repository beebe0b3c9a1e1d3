// SPDX-License-Identifier: BSD-3-Clause
#include "vps/model_estimate.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/solid.h"
#include "vps/voxmap.h"

namespace vps {
namespace {

struct Case {
  const char* name;
  Mesh mesh;
};

std::vector<Case> cases() {
  return {{"box", makeBox({20 * kMm, 15 * kMm, 10 * kMm})},
          {"peg", makeCylinder(5 * kMm, 30 * kMm, 100)},
          {"tube", makeTube(15 * kMm, 8 * kMm, 25 * kMm, 200)},
          {"sphere", makeSphere(12 * kMm, 4)}};
}

// The bounds contain two extremes. The estimate for the box, whose faces lie along the grid and meet the
// fewest bricks, is 1.34 times the built size. For the tube, whose rims have more points than their length
// suggests, the estimate is 0.82 of the cropped points.
TEST(ModelEstimate, WholeModelsTakeAboutWhatIsEstimated) {
  for (const Case& part : cases()) {
    const ModelEstimate estimate(part.mesh, {}, {});
    const Solid solid(part.mesh);
    const VoxMap map = buildVoxMap(solid, {});
    const PointShell shell = buildPointShell(solid, {});
    EXPECT_NEAR(estimate.mapBytes() / static_cast<double>(map.memoryBytes()), 1, 0.4) << part.name;
    EXPECT_NEAR(estimate.pointCount() / static_cast<double>(shell.size()), 1, 0.1) << part.name;
    EXPECT_NEAR(ModelEstimate::shellBytes(static_cast<double>(shell.size())) /
                    static_cast<double>(shell.memoryBytes()),
                1, 0.1)
        << part.name;
  }
}

TEST(ModelEstimate, OfWholeModelsAloneItIsTheSame) {
  for (const Case& part : cases()) {
    const ModelEstimate any(part.mesh, {}, {}), whole(part.mesh, {}, {}, ModelEstimate::Extent::WholeOnly);
    EXPECT_EQ(whole.mapBytes(), any.mapBytes()) << part.name;
    EXPECT_EQ(whole.pointCount(), any.pointCount()) << part.name;
    EXPECT_GT(whole.pointCount(), 0) << part.name;
    const Box far{Vec3::Constant(0.1), Vec3::Constant(0.11)};
    EXPECT_EQ(whole.mapBytes({far}), any.mapBytes()) << part.name;
    EXPECT_EQ(whole.pointCount({far}), any.pointCount()) << part.name;
  }
}

TEST(ModelEstimate, CroppedModelsTakeAboutWhatIsEstimated) {
  for (const Case& part : cases()) {
    const Box all = bounds(part.mesh);
    Box kept = all;
    kept.max.z() = all.center().z();
    const ModelEstimate estimate(part.mesh, {}, {});
    const Solid solid(part.mesh);
    const VoxMap map = croppedVoxMap(buildVoxMap(solid, {}), {kept});
    const PointShell shell = croppedShell(buildPointShell(solid, {}), {kept});
    EXPECT_NEAR(estimate.mapBytes({kept}) / static_cast<double>(map.memoryBytes()), 1, 0.4) << part.name;
    EXPECT_NEAR(estimate.pointCount({kept}) / static_cast<double>(shell.size()), 1, 0.2) << part.name;
  }
}

TEST(ModelEstimate, ABoxBesideThePartKeepsNothing) {
  const ModelEstimate estimate(makeBox({20 * kMm, 15 * kMm, 10 * kMm}), {}, {});
  const Box far{Vec3::Constant(0.1), Vec3::Constant(0.11)};
  EXPECT_EQ(estimate.pointCount({far}), 0);
  EXPECT_LT(estimate.mapBytes({far}), 0.2 * estimate.mapBytes());
}

TEST(ModelEstimate, AMeshThatCannotBeBuiltCostsNothing) {
  Mesh mesh = makeBox({20 * kMm, 15 * kMm, 10 * kMm});
  mesh.vertices[3].y() = NAN;
  const ModelEstimate estimate(mesh, {}, {});
  EXPECT_EQ(estimate.mapBytes(), 0);
  EXPECT_EQ(estimate.pointCount(), 0);
}

}  // namespace
}  // namespace vps
