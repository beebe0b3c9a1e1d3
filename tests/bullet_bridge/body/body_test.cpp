// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/body.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bullet_bridge/world.h"
#include "vps/errors.h"
#include "vps_bullet/log.h"

namespace vps::bullet {
namespace {

using test::World;

/// Moves the mesh away from its frame's origin and turns it, as in CAD files.
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
  // On a slope of 20 degrees (tan 0.364) a body slides with a friction of 0.15 and stays with 0.5.
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
  // The shell has points on the edges in addition to those on the faces.
  EXPECT_GT(large.model->shell->size(), 10'000u);
  EXPECT_LT(large.model->shell->size(), 30'000u);
  EXPECT_LT(large.model->map->memoryBytes(), 64u << 20);
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

template <typename Change>
BodySettings changed(const Change& change) {
  BodySettings settings;
  settings.fidelity = fidelityPreset("fast");
  change(settings);
  return settings;
}

TEST(MakeBody, RefusesMaterialsAndPosesThatNoBodyCanHave) {
  const Mesh cube = makeBox(Vec3::Constant(0.01));
  const auto refuses = [&](const auto& change) {
    EXPECT_THROW(makeBody(cube, changed(change)), std::invalid_argument);
  };
  EXPECT_NO_THROW(makeBody(cube, changed([](BodySettings& s) { s.material.friction = 0; })));
  EXPECT_NO_THROW(makeBody(cube, changed([](BodySettings& s) { s.material.restitution = 1; })));
  refuses([](BodySettings& s) { s.material.friction = -0.1; });
  refuses([](BodySettings& s) { s.material.friction = NAN; });
  refuses([](BodySettings& s) { s.material.friction = INFINITY; });
  refuses([](BodySettings& s) { s.material.restitution = -0.1; });
  refuses([](BodySettings& s) { s.material.restitution = 1.1; });
  refuses([](BodySettings& s) { s.material.restitution = NAN; });
  refuses([](BodySettings& s) { s.X_WP.p.y() = NAN; });
  refuses([](BodySettings& s) { s.X_WP.R *= 2; });
  refuses([](BodySettings& s) { s.X_WP.R = -s.X_WP.R; });
  EXPECT_THROW(makeBody(cube, changed([](BodySettings& s) { s.material.density_kg_m3 = INFINITY; })),
               LoadError);
  EXPECT_THROW(makeBody(cube, changed([](BodySettings& s) { s.material.density_kg_m3 = 0; })), LoadError);
}

TEST(MakeBody, NeedsNoMassForAFixedSheet) {
  Mesh sheet;
  sheet.vertices = {{-0.03, -0.03, 0}, {0.03, -0.03, 0}, {0.03, 0.03, 0}, {-0.03, 0.03, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_THROW(makeBody(sheet, changed([](BodySettings&) {})), LoadError);
  const Body floor = makeBody(sheet, changed([](BodySettings& s) {
                                s.is_fixed = true;
                                s.material.density_kg_m3 = 0;
                              }));
  const Body cube = makeBody(makeBox(Vec3::Constant(0.01)),
                             changed([](BodySettings& s) { s.X_WP = Pose::translation(Vec3(0, 0, 0.006)); }));
  World world;
  world.world->addRigidBody(floor.rigid.get());
  world.world->addRigidBody(cube.rigid.get());
  world.step(200);
  EXPECT_NEAR(cube.X_WP().p.z(), 0.005, 2e-6);
  world.world->removeRigidBody(cube.rigid.get());
  world.world->removeRigidBody(floor.rigid.get());
}

TEST(MakeBody, HasTheMassOfTheSolidWhereTheMeshLacksALid) {
  const Vec3 size_m(0.02, 0.03, 0.04);
  for (const bool is_tube :
       {false, true}) {  // without the upper face, or without both the upper and the lower one
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(0.1, -0.2, 0.3)}) {
      Mesh open = makeBox(size_m);
      std::erase_if(open.triangles, [&](const auto& t) {
        const double sum_m = open.vertices[t[0]].z() + open.vertices[t[1]].z() + open.vertices[t[2]].z();
        return sum_m > size_m.z() || (is_tube && sum_m < -size_m.z());
      });
      open = transformed(open, Pose::translation(place));
      std::string said;
      setLogHook([&](LogLevel, const std::string& message) { said += message; });
      const Body body = makeBody(open, changed([](BodySettings& s) { s.name = "tray"; }));
      setLogHook({});
      const double mass_kg = 7850 * size_m.prod();
      EXPECT_NEAR(body.frame.mass_kg, mass_kg, 1e-9 * mass_kg) << is_tube;
      EXPECT_LT((body.frame.X_PB.p - place).norm(), 1e-9) << is_tube;
      EXPECT_NE(said.find("tray has an open mesh"), std::string::npos) << said;
    }
  }
}

TEST(MakeBody, RefusesAnIndexBeyondBulletsVertices) {
  float vertices[] = {0, 0, 0, 0.02f, 0, 0, 0, 0.02f, 0, 0, 0, 0.02f};
  for (const int last : {3, 4, 30000}) {
    unsigned short indices[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, static_cast<unsigned short>(last)};
    btIndexedMesh part;
    part.m_numTriangles = 4;
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices);
    part.m_triangleIndexStride = 3 * sizeof(unsigned short);
    part.m_numVertices = 4;
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices);
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    btTriangleIndexVertexArray triangles;
    triangles.addIndexedMesh(part, PHY_SHORT);
    if (last == 3)
      EXPECT_EQ(meshOf(triangles).triangles.size(), 4u);
    else
      EXPECT_THROW(meshOf(triangles), std::invalid_argument) << last;
  }
}

}  // namespace
}  // namespace vps::bullet
