// SPDX-License-Identifier: BSD-3-Clause
// Shapes and bodies that are swapped, scaled, deleted and added again at any moment.
#include <gtest/gtest.h>

#include <random>

#include "bullet_bridge/world.h"
#include "support/hostile_world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::World;

void expectClaim(bool claim, const char* promise) {
  EXPECT_TRUE(claim) << promise;
}

const Built& cube(double size_m) {
  static const Built small = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  static const Built large = test::build(makeBox(Vec3::Constant(0.02)), 7850, 0.5e-3, 0.5e-3);
  return size_m < 0.015 ? small : large;
}

TEST(Swap, AShapeByASmallerOneWhileItSlidesOnAnother) {
  World world;
  world.add(test::onePlate(), Pose(), true);
  btRigidBody& body = world.add(cube(0.02), Pose::translation(Vec3(0, 0, 0.015)));
  body.setLinearVelocity(btVector3(toBt(0.1), 0, 0));
  world.step(20);
  body.setCollisionShape(cube(0.01).shape.get());
  world.step(300);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-5) << "it falls by 5 mm and rests";
  body.setWorldTransform(toBt(Pose::translation(Vec3(0, 0, 0.0152))));
  body.setCollisionShape(cube(0.02).shape.get());
  world.step(300);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.015, 1e-5);
}

TEST(Swap, APartByABoxAndBack) {
  // The swap is also tested on a plane, since Bullet has a special algorithm for a plane and a box.
  btStaticPlaneShape plane(btVector3(0, 0, 1), toBt(0.005));
  btBoxShape box(btVector3(toBt(0.005), toBt(0.005), toBt(0.005)));
  for (const bool is_plane : {false, true}) {
    World world;
    btRigidBody& under =
        is_plane ? world.addShape(plane, 0, Vec3::Zero(), Pose()) : world.add(test::onePlate(), Pose(), true);
    btRigidBody& body = world.add(cube(0.01), Pose::translation(Vec3(0, 0, 0.0101)));
    for (btCollisionShape* shape :
         std::initializer_list<btCollisionShape*>{&box, cube(0.01).shape.get(), &box}) {
      world.step(100);
      EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 5e-5)
          << under.getCollisionShape()->getName();
      body.setCollisionShape(shape);
    }
    world.step(100);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 5e-5)
        << under.getCollisionShape()->getName();
  }
}

TEST(Swap, AHullByAnotherWithTheSameBoundingBox) {
  World world;
  world.add(test::onePlate(), Pose(), true);
  const btScalar h = toBt(0.005);
  btConvexHullShape wedge, octahedron;
  for (const btVector3& p : {btVector3(h, h, h), btVector3(-h, h, h), btVector3(-h, -h, -h),
                             btVector3(h, -h, -h), btVector3(h, h, -h), btVector3(-h, h, -h)})
    wedge.addPoint(p);
  for (int k = 0; k < 3; ++k)
    for (const btScalar s : {h, -h}) {
      btVector3 p(0, 0, 0);
      p[k] = s;
      octahedron.addPoint(p);
    }
  btRigidBody& body =
      world.addShape(wedge, 0.01, Vec3::Constant(1e-7), Pose::translation(Vec3(0, 0, 0.0101)));
  world.step(50);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-5);
  body.setCollisionShape(&octahedron);
  body.setWorldTransform(toBt(Pose(rotationFromVector(Vec3(M_PI / 4, 0, 0)), Vec3(0, 0, 0.009))));
  body.setAngularFactor(0);
  world.step(300);
  // On an edge the height is h / sqrt 2; a wedge in this orientation would stand on a corner, at h sqrt 2.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.005 + 0.005 * std::sqrt(0.5), 1e-5);
}

TEST(Swap, AnyRandomSequenceIsSafe) {
  // This test runs the same sequences each time; tests/fuzz runs others.
  std::mt19937 random(17);
  for (int run = 0; run < 40; ++run) {
    std::vector<std::uint8_t> bytes(120);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    vps_test::HostileWorld world(expectClaim, run % 2 == 1);
    world.run(bytes.data(), bytes.size());
    world.finish();
  }
}

}  // namespace
}  // namespace vps::bullet
