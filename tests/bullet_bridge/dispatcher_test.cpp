// SPDX-License-Identifier: BSD-3-Clause
// Pairs looked at by several threads: the same bits.
#include <gtest/gtest.h>

#include <vector>

#include "bullet_bridge/world.h"
#include "vps_bullet/dispatcher.h"

namespace vps {
namespace {

using test::Built;

/// Where seven boxes are that have fallen on one another.
std::vector<btTransform> heap(btCollisionDispatcher& dispatcher, btDefaultCollisionConfiguration& config,
                              ContactMode mode) {
  static const Built box = test::steelBox();
  static const Built ground = test::plate();
  btDbvtBroadphase broadphase;
  VpsSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  VpsBulletSettings settings;
  settings.mode = mode;
  installVps(dispatcher, settings);
  tuneWorld(world);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  const auto add = [&](const Built& part, double mass_kg, const Pose& X_WP) {
    btRigidBody::btRigidBodyConstructionInfo info(
        toBt(mass_kg), nullptr, part.shape.get(),
        toBt(Vec3(mass_kg > 0 ? part.frame.inertia_kg_m2 : Vec3::Zero())));
    info.m_startWorldTransform = toBt(X_WP * part.frame.X_PB);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
  };
  add(ground, 0, Pose::translation(Vec3(0, 0, -0.005)));
  for (int i = 0; i < 7; ++i)
    add(box, box.frame.mass_kg,
        Pose(rotationFromVector(Vec3(0.3 * i, 0.2, 0.1 * i)),
             Vec3(0.006 * (i % 3), 0.005 * (i % 2), 0.012 + 0.013 * i)));
  for (int i = 0; i < 100; ++i) world.stepSimulation(toBt(1e-3), 0);
  std::vector<btTransform> end;
  for (auto& body : bodies) end.push_back(body->getWorldTransform());
  for (auto& body : bodies) world.removeRigidBody(body.get());
  uninstallVps(dispatcher);
  return end;
}

class DispatcherWithMode : public testing::TestWithParam<ContactMode> {};

TEST_P(DispatcherWithMode, AnyNumberOfThreadsGivesTheStockDispatchersBits) {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher stock(&config);
  const std::vector<btTransform> expected = heap(stock, config, GetParam());
  for (const int threads : {1, 2, 5}) {
    VpsDispatcher dispatcher(&config, threads);
    const std::vector<btTransform> got = heap(dispatcher, config, GetParam());
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_TRUE(got[i] == expected[i]) << threads << ", body " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, DispatcherWithMode,
                         testing::Values(ContactMode::Constraint, ContactMode::Penalty),
                         [](const auto& info) {
                           return info.param == ContactMode::Penalty ? "Penalty" : "Constraint";
                         });

TEST(Dispatcher, RefusesLessThanNoThread) {
  btDefaultCollisionConfiguration config;
  EXPECT_THROW(VpsDispatcher(&config, -1), std::invalid_argument);
}

}  // namespace
}  // namespace vps
