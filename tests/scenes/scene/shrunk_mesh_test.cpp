// SPDX-License-Identifier: BSD-3-Clause
#include "models/scene_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/lathe.h"
#include "vps/box.h"

namespace vps::scenes {
namespace {

TEST(ShrunkMesh, EachFaceIsMovedInwards) {
  const double by_m = 10e-6;
  const Mesh box = makeBox(Vec3(1e-3, 2e-3, 3e-3));
  const Mesh small = shrunkMesh(box, by_m);
  EXPECT_LT((bounds(small).size() - (bounds(box).size() - Vec3::Constant(2 * by_m))).norm(), 1e-12);
  const Mesh rod = test::lathe({{0, 0}, {4e-3, 0}, {4e-3, 9e-3}, {0, 9e-3}}, 128);
  // The volume within a prism of 128 sides.
  const double flat = std::cos(std::numbers::pi / 128), face_m = 4e-3 * flat - by_m,
               area = 128 * std::tan(std::numbers::pi / 128);
  EXPECT_NEAR(massProperties(shrunkMesh(rod, by_m)).volume_m3, area * face_m * face_m * (9e-3 - 2 * by_m),
              1e-15);
}

}  // namespace
}  // namespace vps::scenes
