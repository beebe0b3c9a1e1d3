// SPDX-License-Identifier: BSD-3-Clause
// A Shape against every shape type of Bullet: one test for each row of the table in
// bullet_bridge/native_shapes.md.
#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultimaterialTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
using test::slabCorners;
using test::slabHull;
using test::slabMesh;
using test::SolverKind;
using test::UserConcave;
using test::UserConvex;
using test::UserPolyhedron;
using test::World;

const Pose kUpsideDown(rotationFromVector(Vec3(3.14159265358979323846, 0, 0)), Vec3::Zero());

using Make = std::function<void(Ground&)>;
struct Row {
  const char* name;
  Make make;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {"Vps",
       [](Ground& g) {
         static const Built slab = test::build(makeBox(Vec3(0.08, 0.08, 0.02)), 7850, 0.5e-3, kSpacing_m);
         g.shape = slab.shape.get();
         g.X_WB = Pose::translation(Vec3(0, 0, -0.01)) * slab.frame.X_PB;
       }},
      {"Plane", [](Ground& g) { g.shape = &g.keep<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)); }},
      {"Box",
       [](Ground& g) {
         g.shape = &g.keep<btBoxShape>(at(kWide_m, kWide_m, 0.01));
         g.X_WB.p.z() = -0.01;
       }},
      {"BoxScaled",
       [](Ground& g) {
         g.shape = &g.keep<btBoxShape>(at(kWide_m / 2, kWide_m / 4, 0.01));
         g.shape->setLocalScaling(at(2, 4, 1));
         g.X_WB.p.z() = -0.01;
       }},
      {"Sphere",
       [](Ground& g) {
         g.shape = &g.keep<btSphereShape>(toBt(0.02));
         g.X_WB.p.z() = -0.02;
       }},
      {"MultiSphere",
       [](Ground& g) {
         // Three equal balls in a level triangle: their hull is flat on top between them.
         const btVector3 centers[3] = {at(0.03, 0, 0), at(-0.02, 0.03, 0), at(-0.02, -0.03, 0)};
         const btScalar radii[3] = {toBt(0.01), toBt(0.01), toBt(0.01)};
         g.shape = &g.keep<btMultiSphereShape>(centers, radii, 3);
         g.X_WB.p.z() = -0.01;
       }},
      {"MultiSphereOfMany",
       [](Ground& g) {
         // A ring of sixteen balls, more than primitiveDistance() handles. For the error see
         // native_shape_mesh.cpp.
         btVector3 centers[16];
         btScalar radii[16];
         for (int i = 0; i < 16; ++i) {
           centers[i] = at(0.03 * std::cos(i * 0.3926990817), 0.03 * std::sin(i * 0.3926990817), 0);
           radii[i] = toBt(0.01);
         }
         g.shape = &g.keep<btMultiSphereShape>(centers, radii, 16);
         g.X_WB.p.z() = -0.01;
         g.tolerance_m = 1.03e-3 * 0.01;
       }},
      {"MultiSphereScaledUnevenly",
       [](Ground& g) {
         const btVector3 centers[3] = {at(0.015, 0, 0), at(-0.01, 0.015, 0), at(-0.01, -0.015, 0)};
         const btScalar radii[3] = {toBt(0.01), toBt(0.01), toBt(0.01)};
         g.shape = &g.keep<btMultiSphereShape>(centers, radii, 3);
         g.shape->setLocalScaling(at(2, 2, 1));
         g.X_WB.p.z() = -0.01;
         g.tolerance_m = 1.03e-3 * 0.02;
       }},
      {"UserConvex",
       [](Ground& g) {
         g.shape = &g.keep<UserConvex>(at(kWide_m, kWide_m, 0.01));
         g.X_WB.p.z() = -0.01;
       }},
      {"UserPolyhedron",
       [](Ground& g) {
         auto& hull = g.keep<UserPolyhedron>();
         for (const btVector3& p : slabCorners(kWide_m, -0.02, 0)) hull.addPoint(p);
         g.shape = &hull;
       }},
      {"UserConcave",
       [](Ground& g) {
         auto& own = g.keep<UserConcave>();
         own.other = &g.keep<btBvhTriangleMeshShape>(&slabMesh(g), true);
         g.shape = &own;
       }},
      {"Capsule",
       [](Ground& g) {
         g.shape = &g.keep<btCapsuleShapeX>(toBt(0.02), toBt(0.06));
         g.X_WB.p.z() = -0.02;
       }},
      {"Cylinder",
       [](Ground& g) {
         g.shape = &g.keep<btCylinderShapeZ>(at(kWide_m, kWide_m, 0.01));
         g.X_WB.p.z() = -0.01;
       }},
      {"Cone",
       [](Ground& g) {
         g.shape = &g.keep<btConeShapeZ>(toBt(kWide_m), toBt(0.02));
         g.X_WB = Pose::translation(Vec3(0, 0, -0.01)) * kUpsideDown;
       }},
      {"Tetrahedron",
       [](Ground& g) {
         g.shape = &g.keep<btBU_Simplex1to4>(at(0.1, 0, 0), at(-0.05, 0.08, 0), at(-0.05, -0.08, 0),
                                             at(0, 0, -0.05));
       }},
      {"Hull", [](Ground& g) { g.shape = &slabHull(g); }},
      {"HullScaledUnevenly",
       [](Ground& g) {
         g.shape = &slabHull(g, 0.5);
         g.shape->setLocalScaling(at(2, 3, 4));
       }},
      {"PointCloud",
       [](Ground& g) {
         auto& points = g.keep<std::vector<btVector3>>(slabCorners(kWide_m, -0.02, 0));
         g.shape = &g.keep<btConvexPointCloudShape>(points.data(), 8, btVector3(1, 1, 1));
       }},
      {"ConvexTriangleMesh",
       [](Ground& g) {
         g.shape = &g.keep<btConvexTriangleMeshShape>(&slabMesh(g, 0.5));
         g.shape->setLocalScaling(at(2, 2, 2));
       }},
      {"Triangle",
       [](Ground& g) {
         g.shape = &g.keep<btTriangleShape>(at(0.1, 0, 0), at(-0.05, 0.08, 0), at(-0.05, -0.08, 0));
       }},
      {"Box2d", [](Ground& g) { g.shape = &g.keep<btBox2dShape>(at(kWide_m, kWide_m, 0)); }},
      {"MinkowskiSum",
       [](Ground& g) {
         auto& a = g.keep<btBoxShape>(at(0.02, 0.02, 0.005));
         auto& b = g.keep<btBoxShape>(at(0.02, 0.02, 0.005));
         g.shape = &g.keep<btMinkowskiSumShape>(&a, &b);
         // Bullet rounds the sum by its margin, 40 mm by default.
         g.shape->setMargin(0);
         g.X_WB.p.z() = -0.01;
         g.tolerance_m = 5e-9;  // its corners are sums, which are rounded separately
       }},
      {"UniformScalingOfABox",
       [](Ground& g) {
         auto& box = g.keep<btBoxShape>(at(kWide_m / 2, kWide_m / 2, 0.005));
         g.shape = &g.keep<btUniformScalingShape>(&box, btScalar(2));
         g.X_WB.p.z() = -0.01;
       }},
      {"UniformScalingOfASphere",
       [](Ground& g) {
         auto& ball = g.keep<btSphereShape>(toBt(0.01));
         g.shape = &g.keep<btUniformScalingShape>(&ball, btScalar(2));
         g.X_WB.p.z() = -0.02;
       }},
      {"UniformScalingOfAHull",
       [](Ground& g) { g.shape = &g.keep<btUniformScalingShape>(&slabHull(g, 0.5), btScalar(2)); }},
      {"ClosedTriangleMesh",
       [](Ground& g) { g.shape = &g.keep<btBvhTriangleMeshShape>(&slabMesh(g), true); }},
      {"OpenTriangleMesh", [](Ground& g) { g.shape = &g.keep<btBvhTriangleMeshShape>(&floorMesh(g), true); }},
      {"ScaledTriangleMesh",
       [](Ground& g) {
         auto& mesh = g.keep<btBvhTriangleMeshShape>(&slabMesh(g, 0.25), true);
         g.shape = &g.keep<btScaledBvhTriangleMeshShape>(&mesh, at(4, 4, 2));
       }},
      {"MirroredTriangleMesh",
       [](Ground& g) {
         auto& mesh = g.keep<btBvhTriangleMeshShape>(&slabMesh(g), true);
         g.shape = &g.keep<btScaledBvhTriangleMeshShape>(&mesh, at(-1, 1, 1));
       }},
      {"MultimaterialTriangleMesh",
       [](Ground& g) { g.shape = &g.keep<btMultimaterialTriangleMeshShape>(&slabMesh(g), true); }},
      {"Heightfield",
       [](Ground& g) {
         auto& heights = g.keep<std::vector<float>>(21 * 21, 0.0f);
         g.shape =
             &g.keep<btHeightfieldTerrainShape>(21, 21, heights.data(), btScalar(-1), btScalar(1), 2, false);
         g.shape->setLocalScaling(at(0.004, 0.004, 1));
       }},
      {"HeightfieldYUpFlipped",
       [](Ground& g) {
         auto& heights = g.keep<std::vector<float>>(21 * 21, 0.0f);
         auto& field =
             g.keep<btHeightfieldTerrainShape>(21, 21, heights.data(), btScalar(-1), btScalar(1), 1, true);
         field.setFlipTriangleWinding(true);
         field.setLocalScaling(at(0.004, 1, 0.004));
         g.shape = &field;
         g.X_WB.R = rotationFromVector(Vec3(1.5707963267948966, 0, 0));
       }},
      {"GImpact",
       [](Ground& g) {
         auto& mesh = g.keep<btGImpactMeshShape>(&slabMesh(g, 0.5));
         mesh.setLocalScaling(at(2, 2, 2));
         mesh.updateBound();
         g.shape = &mesh;
       }},
      {"CompoundOfCompounds",
       [](Ground& g) {
         // Below one half of the surface is a hull in a nested compound, and below the other half a box.
         auto& inner = g.keep<btCompoundShape>();
         inner.addChildShape(toBt(Pose::translation(Vec3(0.01, 0, 0))), &slabHull(g, 0.25));
         auto& box = g.keep<btBoxShape>(at(0.01, 0.01, 0.01));
         auto& outer = g.keep<btCompoundShape>();
         outer.addChildShape(toBt(Pose::translation(Vec3(0, 0, 0.003))), &inner);
         outer.addChildShape(toBt(Pose::translation(Vec3(-0.01, 0, -0.007))), &box);
         g.shape = &outer;
         g.X_WB.p.z() = -0.003;
       }},
      {"CompoundWithAVpsPart",
       [](Ground& g) {
         auto& inner = g.keep<btCompoundShape>();
         inner.addChildShape(toBt(Pose::translation(Vec3(0, 0, -kHalf_m))), cube().shape.get());
         auto& outer = g.keep<btCompoundShape>();
         outer.addChildShape(btTransform::getIdentity(), &inner);
         g.shape = &outer;
       }},
  };
  return all;
}

class NativeShapeRow : public testing::TestWithParam<Row> {
 protected:
  NativeShapeRow() { GetParam().make(ground_); }
  Ground ground_;
};

TEST_P(NativeShapeRow, APartRestsOnItAtItsHeight) {
  World world;
  world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m + 0.2e-3)));
  body.setAngularFactor(0);  // so that it does not fall off a ball
  world.step(400);
  // A resting part sinks by the solver's residual: less than a micrometre (rest_test.cpp).
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHalf_m, 1e-6 + ground_.tolerance_m);
  EXPECT_LE(body.getLinearVelocity().length(), kIsDouble ? 1e-6 : 2e-5);
  EXPECT_LE(std::hypot(body.getWorldTransform().getOrigin().x(), body.getWorldTransform().getOrigin().y()),
            1e-6);
}

TEST_P(NativeShapeRow, APartRestsOnItWithPenaltyContactToo) {
  World world(SolverKind::Penalty);
  world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m + 0.2e-3)));
  body.setAngularFactor(0);
  world.step(600);
  // On a ball the points that press are at most s / sqrt 2 away from its top: s^2 / (4 r) deep. On a flat
  // surface the weight of 77 mN sinks the part by a nanometre.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHalf_m,
              1e-6 + ground_.tolerance_m + kSpacing_m * kSpacing_m / (4 * 0.01));
  EXPECT_LE(body.getLinearVelocity().length(), 1e-4);
}

TEST_P(NativeShapeRow, QueriesGiveItsDepthAndOppositeNormalsInBothOrders) {
  constexpr double kDepth_m = 30e-6;
  World world;
  btRigidBody& low = world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& high = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m - kDepth_m)));
  Points high_low, low_high, all_of_high, all_of_low;
  world.world->contactPairTest(&high, &low, high_low);
  world.world->contactPairTest(&low, &high, low_high);
  world.world->contactTest(&high, all_of_high);
  world.world->contactTest(&low, all_of_low);
  for (const Points* query : {&high_low, &low_high, &all_of_high, &all_of_low}) {
    ASSERT_FALSE(query->points.empty());
    EXPECT_NEAR(query->least_m(), -kDepth_m, kRounding_m + ground_.tolerance_m);
    // Bullet's normal points from its second body to its first.
    const double up = query->first == &high ? 1 : -1;
    for (const btManifoldPoint& p : query->points)
      if (p.getDistance() < query->least_m() + 1e-9) {
        EXPECT_GE(up * p.m_normalWorldOnB.z(), ground_.tolerance_m > 0 ? 0.999 : 1 - 1e-6);
      }
  }
}

TEST_P(NativeShapeRow, QueriesFindNothingBeyondTheThreshold) {
  World world;
  btRigidBody& low = world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& high = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m + 0.1e-3)));
  Points touching, near(0.2e-3);
  world.world->contactPairTest(&high, &low, touching);
  world.world->contactPairTest(&high, &low, near);
  EXPECT_TRUE(touching.points.empty());
  ASSERT_FALSE(near.points.empty());
  EXPECT_NEAR(near.least_m(), 0.1e-3, kRounding_m + ground_.tolerance_m);
}

INSTANTIATE_TEST_SUITE_P(Rows, NativeShapeRow, testing::ValuesIn(rows()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace vps::bullet
