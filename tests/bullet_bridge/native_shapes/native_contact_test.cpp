// SPDX-License-Identifier: BSD-3-Clause
// Contact with features of Bullet's shapes: corners, open meshes, round sides, slopes.
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_bridge/native_shapes.h"

namespace vps::bullet {
namespace {

using test::at;
using test::Built;
using test::cube;
using test::floorMesh;
using test::Ground;
using test::kHalf_m;
using test::kIsDouble;
using test::kRounding_m;
using test::kSpacing_m;
using test::kWide_m;
using test::Points;
using test::World;

// Depth of a sharp shape in a plate with few points, where it meets the face between them.
double depthInPlate_m(btCollisionShape& sharp, const Pose& X_WB) {
  static const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.004)), 7850, 0.5e-3, 4e-3);
  World world;
  btRigidBody& low = world.addShape(sharp, 0, Vec3::Zero(), X_WB);
  btRigidBody& high = world.add(plate, Pose::translation(Vec3(0.0013, 0.0017, 0.002)));
  Points found;
  world.world->contactPairTest(&high, &low, found);
  return found.points.empty() ? 0 : -found.least_m();
}

TEST(NativeShapeCorners, ThatEnterAFaceBetweenItsPointsAreFound) {
  constexpr double kDepth_m = 50e-6;
  // A box on its corner.
  const Vec3 corner(0.005, 0.005, 0.005);
  const Quat up = Quat::FromTwoVectors(corner, Vec3(0, 0, 1));
  btBoxShape box(toBt(corner));
  EXPECT_NEAR(depthInPlate_m(box, Pose(up.toRotationMatrix(), Vec3(0, 0, kDepth_m - corner.norm()))),
              kDepth_m, kRounding_m);
  btConeShapeZ cone(toBt(0.002), toBt(0.01));
  EXPECT_NEAR(depthInPlate_m(cone, Pose::translation(Vec3(0, 0, kDepth_m - 0.005))), kDepth_m, kRounding_m);
  btConvexHullShape hull;
  btTriangleMesh triangles;
  const btVector3 base[3] = {at(0.002, 0, -0.01), at(-0.001, 0.002, -0.01), at(-0.001, -0.002, -0.01)};
  const btVector3 tip = at(0, 0, 0);
  for (const btVector3& p : base) hull.addPoint(p);
  hull.addPoint(tip);
  for (int k = 0; k < 3; ++k) triangles.addTriangle(base[k], base[(k + 1) % 3], tip);
  EXPECT_NEAR(depthInPlate_m(hull, Pose::translation(Vec3(0, 0, kDepth_m))), kDepth_m, kRounding_m);
  btBvhTriangleMeshShape spike(&triangles, true);  // without a base: a sheet
  EXPECT_NEAR(depthInPlate_m(spike, Pose::translation(Vec3(0, 0, kDepth_m))), kDepth_m, kRounding_m);
  // A cylinder on its rim.
  btCylinderShapeZ cylinder(at(0.005, 0.005, 0.005));
  const Quat on_rim = Quat::FromTwoVectors(Vec3(0.005, 0, 0.005), Vec3(0, 0, 1));
  EXPECT_NEAR(
      depthInPlate_m(cylinder, Pose(on_rim.toRotationMatrix(), Vec3(0, 0, kDepth_m - std::sqrt(5e-5)))),
      kDepth_m, 1e-6);
}

// An open floor and a part near it.
struct OnAFloor {
  Ground ground;
  World world;
  btRigidBody* body = nullptr;
  explicit OnAFloor(const Built& part, const Pose& X_WP) {
    ground.shape = &ground.keep<btBvhTriangleMeshShape>(&floorMesh(ground), true);
    world.addShape(*ground.shape, 0, Vec3::Zero(), Pose());
    body = &world.add(part, X_WP);
  }
  [[nodiscard]] double z() const { return body->getWorldTransform().getOrigin().z(); }
};

TEST(OpenMesh, SupportsAPartOnEitherSide) {
  OnAFloor scene(cube(), Pose::translation(Vec3(0, 0, -kHalf_m - 0.2e-3)));
  scene.world.world->setGravity(btVector3(0, 0, toBt(9.81)));
  scene.body->setGravity(btVector3(0, 0, toBt(9.81)));
  scene.world.step(400);
  EXPECT_NEAR(scene.z(), -kHalf_m, 1e-6);
}

TEST(OpenMesh, SupportsAThinPlate) {
  // The plate's upper face, 1 mm above the floor, must not count as having passed through the floor from
  // below.
  const Built plate = test::build(makeBox(Vec3(0.02, 0.02, 0.001)), 7850, 0.25e-3, kSpacing_m);
  OnAFloor scene(plate, Pose::translation(Vec3(0, 0, 0.0007)));
  scene.world.step(300);
  EXPECT_NEAR(scene.z(), 0.0005, 1e-6);
}

TEST(OpenMesh, APartThatOverlapsItReturnsToItsSide) {
  OnAFloor scene(cube(), Pose::translation(Vec3(0, 0, kHalf_m - 0.3e-3)));
  scene.world.step(400);
  EXPECT_NEAR(scene.z(), kHalf_m, 1e-6);
}

TEST(OpenMesh, EndsAtItsBorder) {
  // The cube is 10 um outside the border, with its lower rim 5 um below the plane, and falls past the floor.
  const double x_m = kWide_m + kHalf_m + 10e-6, z_m = kHalf_m - 5e-6;
  OnAFloor scene(cube(), Pose::translation(Vec3(x_m, 0, z_m)));
  scene.world.step(20);
  EXPECT_NEAR(scene.z(), z_m - 9.81e-6 * 20 * 21 / 2, kIsDouble ? 1e-9 : 1e-7);
  EXPECT_NEAR(scene.body->getWorldTransform().getOrigin().x(), x_m, kRounding_m);
}

TEST(OpenMesh, AFastPartDoesNotTunnel) {
  for (const double speed_m_s : {5.0, 50.0}) {
    OnAFloor scene(cube(), Pose::translation(Vec3(0, 0, 0.2)));
    scene.body->setLinearVelocity(btVector3(0, 0, toBt(-speed_m_s)));
    scene.world.step(150);
    EXPECT_NEAR(scene.z(), kHalf_m, 5e-6) << speed_m_s;
  }
}

// A ball of 3 mm on a part with points a millimetre apart: between them the points are up to 80 um below the
// ball.
TEST(RoundNativeShapes, ABallRollsSmoothlyOverAFace) {
  btSphereShape ball(toBt(0.003));
  World world;
  static const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.004)), 7850, 0.5e-3, kSpacing_m);
  world.add(plate, Pose::translation(Vec3(0, 0, -0.002)), true);
  btVector3 inertia;
  ball.calculateLocalInertia(toBt(0.001), inertia);
  btRigidBody& body =
      world.addShape(ball, 0.001, fromBt(inertia), Pose::translation(Vec3(-0.01, 0.0003, 0.003)));
  body.setLinearVelocity(at(0.05, 0, 0));
  body.setAngularVelocity(at(0, 0.05 / 0.003, 0));
  double lowest = 1, highest = 0;
  for (int i = 0; i < 400; ++i) {
    world.step();
    lowest = std::min<double>(lowest, body.getWorldTransform().getOrigin().z());
    highest = std::max<double>(highest, body.getWorldTransform().getOrigin().z());
  }
  EXPECT_NEAR(lowest, 0.003, 1e-6);
  EXPECT_NEAR(highest, 0.003, 1e-6);
  // Rolling without slip loses no energy.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().x(), 0.01, 1e-4);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().y(), 0.0003, 1e-4);
}

TEST(RoundNativeShapes, LieOnAFaceAlongTheirSide) {
  btCylinderShapeX cylinder(at(0.006, 0.003, 0.003));
  btConeShapeX cone(toBt(0.003), toBt(0.012));
  const double tilt_rad = std::atan(0.25);  // the cone's side is level
  for (btCollisionShape* shape : std::initializer_list<btCollisionShape*>{&cylinder, &cone}) {
    World world;
    static const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.004)), 7850, 0.5e-3, kSpacing_m);
    const bool is_cone = shape == &cone;
    const double height_m = is_cone ? 0.006 * std::sin(tilt_rad) : 0.003;
    const Mat3 R = rotationFromVector(Vec3(0, is_cone ? tilt_rad : 0, 0));
    btRigidBody& low = world.add(plate, Pose::translation(Vec3(0.0003, 0.0004, -0.002)), true);
    constexpr double kDepth_m = 20e-6;
    btRigidBody& high = world.addShape(*shape, 1, Vec3::Ones(), Pose(R, Vec3(0, 0, height_m - kDepth_m)));
    Points found;
    world.world->contactPairTest(&high, &low, found);
    ASSERT_FALSE(found.points.empty()) << shape->getName();
    EXPECT_NEAR(found.least_m(), -kDepth_m, 1e-7) << shape->getName();  // kGain_m of round_contact.cpp
  }
}

// In a bore of nearly its radius a pin touches all around, not along one line.
TEST(RoundNativeShapes, APinInABoreHasContactAllAround) {
  static const Built tube = test::build(makeTube(0.006, 0.00302, 0.01, 256), 7850, 0.25e-3, 0.5e-3);
  btCylinderShapeZ pin(at(0.003, 0.003, 0.008));
  World world;
  btRigidBody& low = world.addShape(pin, 0, Vec3::Zero(), Pose());
  btRigidBody& high = world.add(tube, Pose());
  Points found(40e-6);
  world.world->contactPairTest(&high, &low, found);
  bool has[4] = {};
  for (const btManifoldPoint& p : found.points) {
    EXPECT_NEAR(p.getDistance(), 20e-6, 0.5e-6);  // chords of the tube: 0.00302 (1 - cos(pi / 256)) = 0.23 um
    const btVector3& n = p.m_normalWorldOnB;
    has[(n.x() > 0 ? 1 : 0) + (n.y() > 0 ? 2 : 0)] = true;
  }
  for (const bool quadrant : has) EXPECT_TRUE(quadrant);
}

TEST(Heightfield, HasItsHeightAndNormalOnASlope) {
  // The terrain is z = x / 4, which its triangles represent exactly.
  std::vector<float> heights;
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 21; ++x) heights.push_back(static_cast<float>(0.25 * 0.004 * (x - 10)));
  btHeightfieldTerrainShape field(21, 21, heights.data(), btScalar(-0.1), btScalar(0.1), 2, false);
  field.setLocalScaling(at(0.004, 0.004, 1));
  World world;
  btRigidBody& low = world.addShape(field, 0, Vec3::Zero(), Pose());
  const Mat3 R = rotationFromVector(Vec3(0, -std::atan(0.25), 0));
  constexpr double kDepth_m = 40e-6;
  btRigidBody& high = world.add(cube(), Pose(R, R * Vec3(0, 0, kHalf_m - kDepth_m)));
  Points found;
  world.world->contactPairTest(&high, &low, found);
  ASSERT_FALSE(found.points.empty());
  EXPECT_NEAR(found.least_m(), -kDepth_m, 1e-8);  // the heights are floats
  for (const btManifoldPoint& p : found.points)
    EXPECT_LE((fromBt(p.m_normalWorldOnB) - R.col(2)).norm(), 1e-5);
}

}  // namespace
}  // namespace vps::bullet
