// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/body.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bullet_bridge/world.h"
#include "vps_bullet/log.h"

namespace vps::bullet {
namespace {

using test::World;

/// The mesh moved away from its frame's origin and turned, as CAD parts are.
Mesh displacedBox(const Vec3& size_m) {
  return transformed(makeBox(size_m), Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.05, -0.02, 0.01)));
}

TEST(MakeBody, HasMassInertiaAndPoseOfThePartsOwnFrame) {
  BodySettings settings;
  settings.material.density_kg_m3 = 1000;
  settings.X_WP = Pose(rotationFromVector(Vec3(0, 0.4, 0)), Vec3(1, 2, 3));
  const Body body = makeBody(displacedBox(Vec3(0.02, 0.03, 0.04)), settings);
  const double mass_kg = 1000 * 0.02 * 0.03 * 0.04;
  EXPECT_NEAR(1 / body.rigid->getInvMass(), mass_kg, 1e-6 * mass_kg);
  Vec3 expected(0.02 * 0.02 + 0.03 * 0.03, 0.02 * 0.02 + 0.04 * 0.04, 0.03 * 0.03 + 0.04 * 0.04);
  expected *= mass_kg / 12;
  Vec3 got = fromBt(body.rigid->getLocalInertia());
  std::sort(got.data(), got.data() + 3);
  EXPECT_LT((got - expected).norm(), 1e-6 * expected.norm());
  // Single precision holds metres to 1e-7.
  EXPECT_LT((body.X_WP().p - settings.X_WP.p).norm(), 1e-6);
  EXPECT_LT((body.motion->X_WP().R - settings.X_WP.R).norm(), 1e-6);
  const Vec3 com = settings.X_WP * (Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.05, -0.02, 0.01)).p);
  EXPECT_LT((fromBt(body.rigid->getWorldTransform().getOrigin()) - com).norm(), 1e-6);
}

TEST(MakeBody, FollowsItsMotionInThePartsFrame) {
  World world;
  BodySettings settings;
  settings.X_WP = Pose::translation(Vec3(0, 0, 1));
  const Body body = makeBody(displacedBox(Vec3::Constant(0.01)), settings);
  world.world->addRigidBody(body.rigid.get());
  for (int i = 0; i < 100; ++i) world.world->stepSimulation(toBt(1e-3), 1, toBt(1e-3));
  // Symplectic Euler: g dt^2 n (n + 1) / 2. Bullet interpolates the motion state: it may be late by a step's
  // travel, 0.98 mm.
  EXPECT_NEAR(body.X_WP().p.z(), 1 - 9.81e-6 * 100 * 101 / 2, 1e-6);
  EXPECT_LT((body.motion->X_WP().p - body.X_WP().p).norm(), 0.99e-3);
  world.world->removeRigidBody(body.rigid.get());
}

TEST(MakeBody, GivesThePartsFrictionByBulletsRule) {
  // On a slope of 20 degrees (tan 0.364): steel on steel of mu 0.15 slides, of 0.5 stays.
  for (const double mu : {0.15, 0.5}) {
    BodySettings settings;
    settings.material.friction = mu;
    settings.is_fixed = true;
    const Body ground = makeBody(makeBox(Vec3(0.06, 0.06, 0.01)), settings);
    settings.is_fixed = false;
    settings.X_WP = Pose::translation(Vec3(0, 0, 0.010));
    const Body body = makeBody(makeBox(Vec3::Constant(0.01)), settings);
    World world;
    const double slope = M_PI / 9;
    world.world->setGravity(toBt(Vec3(9.81 * std::sin(slope), 0, -9.81 * std::cos(slope))));
    world.world->addRigidBody(ground.rigid.get());
    world.world->addRigidBody(body.rigid.get());
    world.step(50);
    const double a = 9.81 * (std::sin(slope) - mu * std::cos(slope));
    const double expected = a > 0 ? a * 0.05 * 0.05 / 2 : 0;
    EXPECT_NEAR(body.X_WP().p.x(), expected, 0.05 * expected + 2e-6) << mu;
    world.world->removeRigidBody(body.rigid.get());
    world.world->removeRigidBody(ground.rigid.get());
  }
}

TEST(MakeBody, KeepsToItsBudgetAndSaysWhatItChose) {
  std::string said;
  setLogLevel(LogLevel::Info);
  setLogHook([&](LogLevel, const std::string& message) { said = message; });
  const auto start = std::chrono::steady_clock::now();
  const Body large = makeBody(makeBox(Vec3::Constant(0.2)));
  const double build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  setLogHook({});
  setLogLevel(LogLevel::Warning);
  EXPECT_NE(said.find("200 x 200 x 200 mm"), std::string::npos) << said;
  EXPECT_NE(said.find("points (budget 20000)"), std::string::npos) << said;
  // Edges have points of their own.
  EXPECT_GT(large.model->shell->size(), 10'000u);
  EXPECT_LT(large.model->shell->size(), 30'000u);
  EXPECT_LT(large.model->map->memoryBytes(), 64u << 20);
  EXPECT_LT(build_s, 10) << "was 13 s with a spacing of 0.5 mm";
  RecordProperty("build_ms", static_cast<int>(1e3 * build_s));
}

TEST(MakeBody, TakesTrianglesOfBullet) {
  btTriangleMesh triangles;
  const Mesh cube = makeBox(Vec3::Constant(0.01));
  for (const auto& t : cube.triangles)
    triangles.addTriangle(toBt(cube.vertices[t[0]]), toBt(cube.vertices[t[1]]), toBt(cube.vertices[t[2]]));
  BodySettings settings;
  settings.fidelity = fidelityPreset("fast");
  settings.X_WP = Pose::translation(Vec3(0, 0, 0.006));
  const Body body = makeBody(triangles, settings);
  EXPECT_EQ(body.model->map->voxel_m(), settings.fidelity->voxel_m);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  World world;
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  world.world->addRigidBody(body.rigid.get());
  world.step(200);
  EXPECT_NEAR(body.X_WP().p.z(), 0.005, 2e-6);
  world.world->removeRigidBody(body.rigid.get());
}

TEST(ResolutionFor, RefusesWhatHasNoAnswer) {
  EXPECT_THROW((void)resolutionFor(Mesh(), 1000), std::invalid_argument);
  EXPECT_THROW((void)resolutionFor(makeBox(Vec3::Constant(0.01)), 10), std::invalid_argument);
}

}  // namespace
}  // namespace vps::bullet
