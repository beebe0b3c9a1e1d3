// SPDX-License-Identifier: BSD-3-Clause
// Proofs over sets of poses. Whether a pose without overlap exists is known by construction.
#include "proof/pose_cover.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "search/prism.h"
#include "support/units.h"

namespace vps::scenes {
namespace {

using search::Polygon;
using search::rectangle;

PartSurface surfaceOf(const Mesh& mesh) {
  return {std::make_shared<const Solid>(mesh), 0.0};
}

constexpr double kError_m = 0.5e-6;

/// All poses within 0.5 mm and 0.1 rad.
PoseSet allWithin(double most_m, double most_rad) {
  PoseSet set;
  set.half << most_m, most_m, most_m, most_rad, most_rad, most_rad;
  return set;
}

PoseCover coverOf(const Mesh& part, const Mesh& base, const PoseSet& set,
                  std::size_t most_work = 30'000'000) {
  const PartSurface moving = surfaceOf(part), rest = surfaceOf(base);
  const Obstacle obstacle{&rest, Pose(), kError_m};
  return coverPoses(moving, Pose(), std::span(&obstacle, 1), set, most_work);
}

Polygon sized(double x_m, double y_m) {
  return rectangle({-0.5 * x_m, -0.5 * y_m}, {0.5 * x_m, 0.5 * y_m});
}

Mesh holder(const Polygon& hole) {
  return search::makePrism(sized(30 * kMm, 30 * kMm), {hole}, -4 * kMm, 4 * kMm);
}

class KeyInAHole : public testing::TestWithParam<double> {};

TEST_P(KeyInAHole, OverlapsEverywhereIfItIsLarger) {
  const double over_m = GetParam();
  const Mesh key = search::makePrism(sized(10 * kMm, 6 * kMm), {}, -6 * kMm, 6 * kMm);
  const PoseCover cover =
      coverOf(key, holder(sized(10 * kMm - over_m, 6 * kMm + 20 * kUm)), allWithin(0.5 * kMm, 0.1));
  EXPECT_TRUE(cover.is_proven) << cover.cells << " cells, " << cover.work << " work, free "
                               << cover.free.has_value();
}
TEST_P(KeyInAHole, IsFreeSomewhereIfItIsSmaller) {
  const double under_m = GetParam();
  const Mesh key = search::makePrism(sized(10 * kMm, 6 * kMm), {}, -6 * kMm, 6 * kMm);
  const PoseCover cover =
      coverOf(key, holder(sized(10 * kMm + under_m, 6 * kMm + 20 * kUm)), allWithin(0.5 * kMm, 0.1));
  EXPECT_FALSE(cover.is_proven);
  EXPECT_TRUE(cover.free.has_value());
}
INSTANTIATE_TEST_SUITE_P(By, KeyInAHole, testing::Values(5e-6, 10e-6, 20e-6, 50e-6, 200e-6));

}  // namespace
}  // namespace vps::scenes
