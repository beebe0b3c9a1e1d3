// SPDX-License-Identifier: BSD-3-Clause
// Bodies of open meshes are met at the drawn surface, from both sides, and nowhere else.
#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
#include <LinearMath/btSerializer.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_bridge/world.h"
#include "vps_bullet/body.h"
#include "vps_bullet/world_importer.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::kIsDouble;
using test::World;

constexpr double kHalf_m = 8e-3;       ///< of the cube; radius of the ball
constexpr double kTolerance_m = 2e-6;  ///< edges rest 0.1 um above faces, and a step of gravity is 10 um

void addQuad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& v : {a, b, c, d}) mesh.vertices.push_back(v);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A floor with two walls that have opposite winding.
Mesh channel() {
  const double x = 0.1, y = 0.03, z = 0.03;
  Mesh mesh;
  addQuad(mesh, {-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0});
  addQuad(mesh, {-x, y, 0}, {x, y, 0}, {x, y, z}, {-x, y, z});
  addQuad(mesh, {-x, -y, 0}, {x, -y, 0}, {x, -y, z}, {-x, -y, z});
  return welded(mesh);
}

BodySettings settingsOf(const char* name, bool is_fixed, const Pose& X_WP = {}) {
  BodySettings settings;
  settings.name = name;
  settings.is_fixed = is_fixed;
  settings.X_WP = X_WP;
  settings.fidelity = Fidelity{.voxel_m = 1e-3, .spacing_m = 2e-3};
  return settings;
}

/// The channel, and one of Bullet's balls or a cube part.
struct Fall {
  World world;
  Body channel_body, cube;
  btSphereShape ball{toBt(kHalf_m)};
  btRigidBody* falling = nullptr;

  Fall(bool is_cube, const Vec3& at, double g_m_s2 = -9.81, OpenMesh open = OpenMesh::Sheet) {
    BodySettings settings = settingsOf("channel", true);
    settings.open_mesh = open;
    channel_body = makeBody(channel(), settings);
    world.world->addRigidBody(channel_body.rigid.get());
    if (is_cube) {
      cube = makeBody(makeBox(Vec3::Constant(2 * kHalf_m)), settingsOf("cube", false, Pose::translation(at)));
      falling = cube.rigid.get();
      world.world->addRigidBody(falling);
    } else {
      falling = &world.addShape(ball, 0.1, Vec3::Constant(2.56e-6), Pose::translation(at));
    }
    falling->setActivationState(DISABLE_DEACTIVATION);
    falling->setGravity(btVector3(0, 0, toBt(g_m_s2)));
  }
  ~Fall() {
    world.world->removeRigidBody(channel_body.rigid.get());
    if (cube.rigid) world.world->removeRigidBody(cube.rigid.get());
  }
  [[nodiscard]] Vec3 place() const { return fromBt(falling->getWorldTransform().getOrigin()); }
};

TEST(Sheet, AChannelHoldsWhatFallsIntoItOnItsFloor) {
  for (const bool is_cube : {false, true}) {
    Fall fall(is_cube, Vec3(0.01, 0.003, 0.05));
    fall.world.step(300);
    EXPECT_NEAR(fall.place().z(), kHalf_m, kTolerance_m) << is_cube;
  }
}

TEST(Sheet, IsMetFromBelowToo) {
  for (const bool is_cube : {false, true}) {
    Fall fall(is_cube, Vec3(0.01, 0.003, -0.02), 9.81);
    fall.world.step(300);
    EXPECT_NEAR(fall.place().z(), -kHalf_m, kTolerance_m) << is_cube;
  }
}

TEST(Sheet, WallsHoldOnTheirInsideWhicheverWayTheyAreWound) {
  for (const bool is_cube : {false, true})
    for (const double side : {-1.0, 1.0}) {
      Fall fall(is_cube, Vec3(0, 0, kHalf_m + 1e-6));
      fall.falling->setLinearVelocity(btVector3(0, toBt(0.5 * side), 0));
      double farthest_m = 0;
      for (int i = 0; i < 200; ++i) {
        fall.world.step();
        farthest_m = std::max(farthest_m, side * fall.place().y());
      }
      EXPECT_NEAR(farthest_m, 0.03 - kHalf_m, kTolerance_m) << is_cube << side;
    }
}

TEST(Sheet, EndsAtItsBorder) {
  for (const bool is_cube : {false, true}) {
    Fall fall(is_cube, Vec3(0.1 + kHalf_m + 20e-6, 0, 0.005));
    fall.world.step(60);
    EXPECT_NEAR(fall.place().z(), 0.005 - 9.81e-6 * 60 * 61 / 2, kIsDouble ? 1e-9 : 1e-6) << is_cube;
  }
}

TEST(Sheet, ItsBorderIsARim) {
  // The middle of the ball, and the faces of the cube, meet the end of the floor edge-on.
  for (const bool is_cube : {false, true}) {
    Fall fall(is_cube, Vec3(0.1 + kHalf_m + 1e-3, 0, 0), 0);
    fall.falling->setLinearVelocity(btVector3(toBt(-0.2), 0, 0));
    fall.world.step(100);
    EXPECT_NEAR(fall.place().x(), 0.1 + kHalf_m, 10e-6) << is_cube;
  }
}

TEST(Sheet, DeclaredASolidItIsClosed) {
  Fall fall(false, Vec3(0.01, 0.003, 0.05), -9.81, OpenMesh::Solid);
  EXPECT_FALSE(fall.channel_body.model->solid->isSheet());
  EXPECT_NE(fall.channel_body.model->map, nullptr);
}

TEST(Sheet, ScalesWithItsBorder) {
  for (const bool is_cube : {false, true}) {
    Fall fall(is_cube, Vec3(0.15, 0.003, 0.02));  // beyond the border of the unscaled channel
    fall.channel_body.shape->setLocalScaling(btVector3(2, 2, 2));
    fall.world.world->updateSingleAabb(fall.channel_body.rigid.get());
    fall.world.step(200);
    const double floor_m = -fall.channel_body.frame.X_PB.p.z();  // scaled about the body's centre
    EXPECT_NEAR(fall.place().z(), floor_m + kHalf_m, kTolerance_m) << is_cube;
  }
}

TEST(Sheet, IsASheetWhenItIsLoadedAgain) {
  Fall fall(true, Vec3(0, 0, 0.02));
  btDefaultSerializer serializer;
  fall.world.world->serialize(&serializer);
  std::vector<char> file(serializer.getBufferPointer(),
                         serializer.getBufferPointer() + serializer.getCurrentBufferSize());
  World second;
  WorldImporter importer(second.world.get());
  ASSERT_TRUE(importer.loadFileFromMemory(file.data(), static_cast<int>(file.size())));
  int sheets = 0;
  for (int i = 0; i < importer.getNumRigidBodies(); ++i) {
    const auto* shape =
        dynamic_cast<const Shape*>(btRigidBody::upcast(importer.getRigidBodyByIndex(i))->getCollisionShape());
    ASSERT_NE(shape, nullptr);
    sheets += shape->models().surfaces[0].sheet != nullptr;
  }
  EXPECT_EQ(sheets, 1);
}

/// Waves of 30 mm, 4 m long and wide.
Mesh waves() {
  Mesh mesh;
  constexpr int kCells = 60;
  const auto at = [](int i, int j) {
    const double x = 4.0 * i / kCells - 2, y = 4.0 * j / kCells - 2;
    return Vec3(x, y, 0.03 * std::sin(4 * x) * std::cos(3 * y));
  };
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return welded(mesh, 1e-9);
}

// A raycast vehicle drives the same path on the terrain as on Bullet's own mesh of it.
TEST(Sheet, AVehicleOnRaysDrivesAsOnBulletsMesh) {
  World world;
  const Mesh mesh = waves();
  BodySettings settings = settingsOf("terrain", true);
  settings.fidelity = Fidelity{.voxel_m = 0.02, .spacing_m = 0.04};
  const Body terrain = makeBody(mesh, settings);
  world.world->addRigidBody(terrain.rigid.get());
  btTriangleMesh triangles;
  for (const auto& t : mesh.triangles)
    triangles.addTriangle(toBt(mesh.vertices[t[0]]), toBt(mesh.vertices[t[1]]), toBt(mesh.vertices[t[2]]));
  btBvhTriangleMeshShape bvh(&triangles, true);
  const Vec3 aside(0, 10, 0);
  world.addShape(bvh, 0, Vec3::Zero(), Pose::translation(aside));
  btBoxShape box(toBt(Vec3(0.25, 0.12, 0.05)));
  Vec3 end[2];
  for (const bool is_ours : {true, false}) {
    btRigidBody& chassis =
        world.addShape(box, 20, Vec3(0.2, 0.5, 0.6),
                       Pose::translation(Vec3(-1.5, 0, 0.2) + (is_ours ? Vec3(Vec3::Zero()) : aside)));
    btRaycastVehicle::btVehicleTuning tuning;
    tuning.m_suspensionStiffness = 40;
    btDefaultVehicleRaycaster rays(world.world.get());
    btRaycastVehicle car(tuning, &chassis, &rays);
    car.setCoordinateSystem(1, 2, 0);
    for (const double x : {-0.2, 0.2})
      for (const double y : {-0.15, 0.15})
        car.addWheel(toBt(Vec3(x, y, -0.02)), btVector3(0, 0, -1), btVector3(0, -1, 0), toBt(0.1), toBt(0.08),
                     tuning, x > 0);
    world.world->addAction(&car);
    world.step(400);
    for (int wheel = 0; wheel < 4; ++wheel) car.applyEngineForce(10, wheel);
    world.step(1200);
    end[is_ours ? 0 : 1] =
        fromBt(chassis.getWorldTransform().getOrigin()) - (is_ours ? Vec3(Vec3::Zero()) : aside);
    world.world->removeAction(&car);
  }
  EXPECT_GT(end[0].x(), -1.2) << "it drives";
  EXPECT_LT((end[0] - end[1]).norm(), 1e-3);
  world.world->removeRigidBody(terrain.rigid.get());
}

}  // namespace
}  // namespace vps::bullet
