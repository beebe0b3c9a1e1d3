// SPDX-License-Identifier: BSD-3-Clause
// Pairs processed by several threads give the same bits.
#include <gtest/gtest.h>

#include <vector>

#include "bullet_bridge/world.h"
#include "vps_bullet/dispatcher.h"

namespace vps::bullet {
namespace {

using test::Built;

/// Final poses of seven boxes that fell on one another. With 0 threads the stock dispatcher is used.
std::vector<btTransform> heap(int threads, test::SolverKind solver) {
  static const Built box = test::steelBox();
  static const Built ground = test::plate();
  test::World world(solver, {}, 100, {}, threads);
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  for (int i = 0; i < 7; ++i)
    world.add(box, Pose(rotationFromVector(Vec3(0.3 * i, 0.2, 0.1 * i)),
                        Vec3(0.006 * (i % 3), 0.005 * (i % 2), 0.012 + 0.013 * i)));
  return test::placesAfter(world, 100);
}

class DispatcherWithMode : public testing::TestWithParam<test::SolverKind> {};

TEST_P(DispatcherWithMode, AnyNumberOfThreadsGivesTheStockDispatchersBits) {
  const std::vector<btTransform> expected = heap(0, GetParam());
  for (const int threads : {1, 2, 5}) {
    const std::vector<btTransform> got = heap(threads, GetParam());
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_TRUE(got[i] == expected[i]) << threads << ", body " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, DispatcherWithMode,
                         testing::Values(test::SolverKind::Constraint, test::SolverKind::Penalty),
                         [](const auto& info) {
                           return info.param == test::SolverKind::Penalty ? "Penalty" : "Constraint";
                         });

TEST(Dispatcher, RefusesANegativeNumberOfThreads) {
  btDefaultCollisionConfiguration config;
  EXPECT_THROW(Dispatcher(&config, -1), std::invalid_argument);
}

}  // namespace
}  // namespace vps::bullet
