// SPDX-License-Identifier: BSD-3-Clause
// A Shape against every shape type of Bullet: the table of bullet_bridge/README.md, row by row.
#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultimaterialTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "bullet_bridge/world.h"
#include "native_shapes/native_shape_adapter.h"
#include "native_shapes/native_shape_mesh.h"
#include "native_shapes/primitive.h"
#include "vps_bullet/dispatcher.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

constexpr bool kIsDouble = sizeof(btScalar) == 8;
// Bullet's own arithmetic on coordinates of centimetres: in floats 4 nm, and a few of those add up.
constexpr double kRounding_m = kIsDouble ? 1e-9 : 5e-8;
constexpr double kSpacing_m = 1e-3;
constexpr double kHalf_m = 0.005;

const Built& cube() {
  static const Built built = test::build(makeBox(Vec3::Constant(2 * kHalf_m)), 7850, 0.5e-3, kSpacing_m);
  return built;
}

btVector3 at(double x, double y, double z) {
  return {toBt(x), toBt(y), toBt(z)};
}

/// A shape with a level top at z = 0 around the origin, and all that it refers to.
struct Ground {
  btCollisionShape* shape = nullptr;
  Pose X_WB;
  double tolerance_m = 0;  ///< of a height, beyond rounding
  std::vector<std::shared_ptr<void>> kept;

  template <typename T, typename... A>
  T& keep(A&&... a) {
    // Bullet's shapes want its own aligned memory, which its operator new gives.
    std::shared_ptr<T> made(new T(std::forward<A>(a)...));
    kept.push_back(made);
    return *made;
  }
};

constexpr double kWide_m = 0.04;

std::vector<btVector3> slabCorners(double wide_m, double low_m, double high_m) {
  std::vector<btVector3> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(at(c & 1 ? wide_m : -wide_m, c & 2 ? wide_m : -wide_m, c & 4 ? high_m : low_m));
  return corners;
}

btTriangleMesh& slabMesh(Ground& ground, double scale = 1) {
  btTriangleMesh& mesh = ground.keep<btTriangleMesh>();
  const Mesh box = makeBox(Vec3(2 * kWide_m, 2 * kWide_m, 0.02) * scale);
  for (const auto& t : box.triangles) {
    btVector3 p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = toBt(Vec3(box.vertices[t[k]] - Vec3(0, 0, 0.01 * scale)));
    mesh.addTriangle(p[0], p[1], p[2]);
  }
  return mesh;
}

btTriangleMesh& floorMesh(Ground& ground) {
  btTriangleMesh& mesh = ground.keep<btTriangleMesh>();
  mesh.addTriangle(at(-kWide_m, -kWide_m, 0), at(kWide_m, -kWide_m, 0), at(kWide_m, kWide_m, 0));
  mesh.addTriangle(at(-kWide_m, -kWide_m, 0), at(kWide_m, kWide_m, 0), at(-kWide_m, kWide_m, 0));
  return mesh;
}

btConvexHullShape& slabHull(Ground& ground, double scale = 1) {
  auto& hull = ground.keep<btConvexHullShape>();
  for (const btVector3& p : slabCorners(kWide_m * scale, -0.02 * scale, 0)) hull.addPoint(p);
  return hull;
}

const Pose kUpsideDown(rotationFromVector(Vec3(3.14159265358979323846, 0, 0)), Vec3::Zero());

// Types of a user's own.
struct OwnConvex : btConvexInternalShape {
  btVector3 half;
  explicit OwnConvex(const btVector3& half_m) : half(half_m) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(0);
  }
  [[nodiscard]] btVector3 localGetSupportingVertexWithoutMargin(const btVector3& v) const override {
    return {v.x() < 0 ? -half.x() : half.x(), v.y() < 0 ? -half.y() : half.y(),
            v.z() < 0 ? -half.z() : half.z()};
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* v, btVector3* out,
                                                         int n) const override {
    for (int i = 0; i < n; ++i) out[i] = localGetSupportingVertexWithoutMargin(v[i]);
  }
  void calculateLocalInertia(btScalar, btVector3&) const override {}
  const char* getName() const override { return "OwnConvex"; }
};
struct OwnPolyhedron : btConvexHullShape {
  OwnPolyhedron() { m_shapeType = CUSTOM_POLYHEDRAL_SHAPE_TYPE; }
};
struct OwnConcave : btConcaveShape {
  const btConcaveShape* other = nullptr;  // whose triangles it has
  btVector3 one{1, 1, 1};
  OwnConcave() { m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE; }
  void getAabb(const btTransform& X, btVector3& low, btVector3& high) const override {
    other->getAabb(X, low, high);
  }
  void processAllTriangles(btTriangleCallback* visit, const btVector3& low,
                           const btVector3& high) const override {
    other->processAllTriangles(visit, low, high);
  }
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return one; }
  void calculateLocalInertia(btScalar, btVector3&) const override {}
  const char* getName() const override { return "OwnConcave"; }
};

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
         // A ring of sixteen balls: more than are solved exactly. Error: partner_mesh.cpp.
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
      {"OwnConvex",
       [](Ground& g) {
         g.shape = &g.keep<OwnConvex>(at(kWide_m, kWide_m, 0.01));
         g.X_WB.p.z() = -0.01;
       }},
      {"OwnPolyhedron",
       [](Ground& g) {
         auto& hull = g.keep<OwnPolyhedron>();
         for (const btVector3& p : slabCorners(kWide_m, -0.02, 0)) hull.addPoint(p);
         g.shape = &hull;
       }},
      {"OwnConcave",
       [](Ground& g) {
         auto& own = g.keep<OwnConcave>();
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
         // Bullet rounds the sum by its margin, 40 mm unless one asks for another.
         g.shape->setMargin(0);
         g.X_WB.p.z() = -0.01;
         g.tolerance_m = 5e-9;  // its corners, sums, are rounded apart
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
         // A hull under one half, a box under the other, a level deeper.
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

class NativeShapeAdapter : public testing::TestWithParam<Row> {
 protected:
  NativeShapeAdapter() { GetParam().make(ground_); }
  Ground ground_;
};

// All points that a query reports, with body 0 of the query first.
struct Points : btCollisionWorld::ContactResultCallback {
  std::vector<btManifoldPoint> points;
  explicit Points(double threshold_m = 0) { m_closestDistanceThreshold = toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    points.push_back(point);
    first = a->getCollisionObject();
    return 0;
  }
  const btCollisionObject* first = nullptr;
  [[nodiscard]] double least_m() const {
    double least = 1e30;
    for (const btManifoldPoint& p : points) least = std::min<double>(least, p.getDistance());
    return least;
  }
};

TEST_P(NativeShapeAdapter, APartRestsOnItAtItsHeight) {
  World world;
  world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m + 0.2e-3)));
  body.setAngularFactor(0);  // so that it stays up on a ball too
  world.step(400);
  // A resting part sinks by what the solver leaves: under a micrometre (rest_test.cpp).
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHalf_m, 1e-6 + ground_.tolerance_m);
  EXPECT_LE(body.getLinearVelocity().length(), kIsDouble ? 1e-6 : 2e-5);
  EXPECT_LE(std::hypot(body.getWorldTransform().getOrigin().x(), body.getWorldTransform().getOrigin().y()),
            1e-6);
}

TEST_P(NativeShapeAdapter, APartRestsOnItInPenaltyModeToo) {
  World world(SolverKind::Penalty);
  world.addShape(*ground_.shape, 0, Vec3::Zero(), ground_.X_WB);
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, kHalf_m + 0.2e-3)));
  body.setAngularFactor(0);
  world.step(600);
  // On a ball a face's points press that are at most s / sqrt 2 off its top: s^2 / (4 r) deep. On a flat the
  // weight of 77 mN sinks it by a nanometre.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), kHalf_m,
              1e-6 + ground_.tolerance_m + kSpacing_m * kSpacing_m / (4 * 0.01));
  EXPECT_LE(body.getLinearVelocity().length(), 1e-4);
}

TEST_P(NativeShapeAdapter, QueriesGiveItsDepthAndOppositeNormalsInBothOrders) {
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

TEST_P(NativeShapeAdapter, QueriesFindNothingBeyondTheThreshold) {
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

TEST(NativeShapeMesh, ABoxHasEightCornersAndACylindersRimIsWithinAMicrometre) {
  const btBoxShape box(at(0.01, 0.02, 0.03));
  EXPECT_EQ(partnerMesh(box).mesh.vertices.size(), 8u);
  EXPECT_LE((bounds(partnerMesh(box).mesh).max - Vec3(0.01, 0.02, 0.03)).norm(), kRounding_m);
  const btCylinderShapeX cylinder(at(0.03, 0.01, 0.01));
  const NativeShapeMesh rim = partnerMesh(cylinder);
  EXPECT_NEAR(bounds(rim.mesh).max.x(), 0.03, kRounding_m);
  for (const auto& t : rim.mesh.triangles) {
    const Vec3 middle = 0.5 * (rim.mesh.vertices[t[0]] + rim.mesh.vertices[t[1]]);
    const double radius_m = std::hypot(middle.y(), middle.z());
    if (std::abs(rim.mesh.vertices[t[0]].x()) > 0.029 && radius_m > 0.009) {
      EXPECT_GE(radius_m, 0.01 - 1.01e-6);
    }
  }
}

// Every direction of a fine sphere: max over n of n.p - h(n), from below by the sphere's grain.
double distanceBySupport(const btConvexShape& shape, const Vec3& p) {
  static const std::vector<Vec3> directions = makeSphere(1, 6).vertices;
  double best = -1e30;
  for (const Vec3& n : directions)
    best = std::max(best, n.dot(p - fromBt(shape.localGetSupportingVertex(toBt(n)))));
  return best;
}

TEST(Primitive, DistanceToAMultiSphereIsThatOfItsSupportFunction) {
  const btVector3 centers[4] = {at(0, 0, 0), at(0.02, 0, 0), at(0, 0.03, 0), at(0.005, 0.005, 0.02)};
  const btScalar radii[4] = {toBt(0.005), toBt(0.008), toBt(0.002), toBt(0.004)};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.02, 0.05);
  for (int count = 1; count <= 4; ++count) {
    btMultiSphereShape shape(centers, radii, count);
    ASSERT_TRUE(isPrimitive(shape));
    for (int i = 0; i < 20; ++i) {
      const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
      const SurfaceDistance d = primitiveDistance(shape, p);
      // From below by the grain of 40,962 directions: 0.6 degrees, times the way to the support, 0.07 m,
      // where two spheres meet; from above by the way back, which must end on the hull.
      EXPECT_NEAR(d.distance_m, distanceBySupport(shape, p), 0.07 * std::sin(0.6 / 57.3)) << p.transpose();
      EXPECT_GE(d.distance_m, distanceBySupport(shape, p) - kRounding_m);
      EXPECT_NEAR(d.n.norm(), 1, 1e-12);
      EXPECT_NEAR(primitiveDistance(shape, p - d.distance_m * d.n).distance_m, 0, 1e-9);
    }
  }
}

TEST(Primitive, DistanceToAConeIsThatToItsMesh) {
  const btConeShape cone(toBt(0.01), toBt(0.03));
  const MeshDistance mesh(partnerMesh(cone).mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.025, 0.025);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    // The mesh's chords are within 1 um of the cone's circles.
    EXPECT_NEAR(primitiveDistance(cone, p).distance_m, mesh.signedDistance(p), 1e-6 + kRounding_m)
        << p.transpose();
  }
}

// A plate with few points, and something sharp under it that meets its face between them.
double depthInPlate_m(btCollisionShape& sharp, const Pose& X_WB) {
  static const Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.004)), 7850, 0.5e-3, 4e-3);
  World world;
  btRigidBody& low = world.addShape(sharp, 0, Vec3::Zero(), X_WB);
  btRigidBody& high = world.add(plate, Pose::translation(Vec3(0.0013, 0.0017, 0.002)));
  Points found;
  world.world->contactPairTest(&high, &low, found);
  return found.points.empty() ? 0 : -found.least_m();
}

TEST(PartnerCorners, ThatPokeIntoAFaceBetweenItsPointsAreFound) {
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
  btBvhTriangleMeshShape spike(&triangles, true);  // without its base: a sheet
  EXPECT_NEAR(depthInPlate_m(spike, Pose::translation(Vec3(0, 0, kDepth_m))), kDepth_m, kRounding_m);
  // A cylinder on its rim.
  btCylinderShapeZ cylinder(at(0.005, 0.005, 0.005));
  const Quat on_rim = Quat::FromTwoVectors(Vec3(0.005, 0, 0.005), Vec3(0, 0, 1));
  EXPECT_NEAR(
      depthInPlate_m(cylinder, Pose(on_rim.toRotationMatrix(), Vec3(0, 0, kDepth_m - std::sqrt(5e-5)))),
      kDepth_m, 1e-6);
}

// The open floor of the rows above, and a part somewhere at it.
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

TEST(OpenMesh, HoldsAPartFromBelowAsFromAbove) {
  OnAFloor scene(cube(), Pose::translation(Vec3(0, 0, -kHalf_m - 0.2e-3)));
  scene.world.world->setGravity(btVector3(0, 0, toBt(9.81)));
  scene.body->setGravity(btVector3(0, 0, toBt(9.81)));
  scene.world.step(400);
  EXPECT_NEAR(scene.z(), -kHalf_m, 1e-6);
}

TEST(OpenMesh, HoldsAThinPlate) {
  // Its upper face, 1 mm above the floor, has not come through the floor from below.
  const Built plate = test::build(makeBox(Vec3(0.02, 0.02, 0.001)), 7850, 0.25e-3, kSpacing_m);
  OnAFloor scene(plate, Pose::translation(Vec3(0, 0, 0.0007)));
  scene.world.step(300);
  EXPECT_NEAR(scene.z(), 0.0005, 1e-6);
}

TEST(OpenMesh, APartPushedThroughABitComesBackOnItsSide) {
  OnAFloor scene(cube(), Pose::translation(Vec3(0, 0, kHalf_m - 0.3e-3)));
  scene.world.step(400);
  EXPECT_NEAR(scene.z(), kHalf_m, 1e-6);
}

TEST(OpenMesh, EndsAtItsBorder) {
  // Beside it, 10 um off and with its lower rim 5 um below its plane: it falls past.
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

// A ball of 3 mm on a part with points a millimetre apart: they are up to 80 um below it between them.
TEST(RoundNativeShapes, ABallRollsOverAFaceAsIfItHadNoPoints) {
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
  // Rolling without slip loses nothing; Bullet's contact is placed to the nanometre, so neither does it here.
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

// In a bore of nearly its radius all of its side is in contact, not one line of it.
TEST(RoundNativeShapes, APinInABoreIsHeldAllAround) {
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

TEST(Heightfield, IsAsHighAsItsSlopeSays) {
  // z = x / 4, exact on its triangles.
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

TEST(NativeShapes, ADynamicHullRestsOnAVpsPart) {
  btConvexHullShape hull;
  for (const btVector3& p : slabCorners(0.004, -0.004, 0.004)) hull.addPoint(p);
  World world;
  world.add(cube(), Pose(), true);
  btVector3 inertia;
  hull.setMargin(0);
  hull.calculateLocalInertia(toBt(0.004), inertia);
  btRigidBody& body = world.addShape(hull, 0.004, fromBt(inertia), Pose::translation(Vec3(0, 0, 0.0092)));
  world.step(500);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.009, 1e-6);
  EXPECT_LE(body.getAngularVelocity().length(), kIsDouble ? 1e-4 : 2e-3);
}

TEST(NativeShapes, AShapeThatIsResizedIsMetAsItIsNow) {
  World world;
  btConvexHullShape hull;
  for (const btVector3& p : slabCorners(0.03, -0.004, 0.004)) hull.addPoint(p);
  btRigidBody& low = world.addShape(hull, 0, Vec3::Zero(), Pose());
  btRigidBody& body = world.add(cube(), Pose::translation(Vec3(0, 0, 0.0092)));
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.009, 1e-6);
  hull.setLocalScaling(at(1, 1, 0.5));
  world.world->updateSingleAabb(&low);
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.007, 1e-6);
}

// Seven cubes over four kinds of partner; where they are after a tenth of a second. 0 threads: the stock
// dispatcher.
std::vector<btTransform> fallOnNativeShapes(int threads) {
  Ground ground;
  btBoxShape box(at(0.02, 0.02, 0.01));
  btSphereShape ball(toBt(0.02));
  btCollisionShape* shapes[] = {&slabHull(ground, 0.5), &box,
                                &ground.keep<btBvhTriangleMeshShape>(&floorMesh(ground), true), &ball};
  World world(SolverKind::Constraint, {}, 100, {}, threads);
  for (int i = 0; i < 4; ++i)
    world.addShape(*shapes[i], 0, Vec3::Zero(), Pose::translation(Vec3(0.015 * i, 0.01 * (i % 2), -0.012)));
  for (int i = 0; i < 7; ++i)
    world.addShape(*cube().shape, cube().frame.mass_kg, cube().frame.inertia_kg_m2,
                   Pose(rotationFromVector(Vec3(0.3 * i, 0.2, 0.1 * i)),
                        Vec3(0.012 * (i % 4), 0, 0.01 + 0.012 * (i / 4))));
  return test::placesAfter(world, 100);
}

TEST(NativeShapes, AreMetBySeveralThreadsWithTheSameBits) {
  const std::vector<btTransform> expected = fallOnNativeShapes(0);
  for (const int threads : {1, 3}) {
    const std::vector<btTransform> got = fallOnNativeShapes(threads);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_TRUE(got[i] == expected[i]) << threads << ", body " << i;
  }
}

TEST(NativeShapeCache, SharesOneStandInAndKnowsAShapeThatHasComeToLieAtTheSamePlace) {
  NativeShapeCache cache;
  alignas(16) std::array<unsigned char, sizeof(btConvexHullShape)> room;
  const auto slab = [](double low_m) {
    // Boxes of equal size: only the corners differ.
    std::vector<btVector3> corners = slabCorners(0.01, -0.01, 0.01);
    corners[0] = at(-0.01, -0.01, low_m);
    return corners;
  };
  const auto place = [&](double low_m) {
    auto* hull = new (room.data()) btConvexHullShape();
    for (const btVector3& p : slab(low_m)) hull->addPoint(p);
    return hull;
  };
  btConvexHullShape* hull = place(-0.01);
  const NativeShape* first = cache.get(*hull).get();
  EXPECT_EQ(cache.get(*hull).get(), first);
  hull->~btConvexHullShape();
  hull = place(-0.009);
  const auto corner_of_first = Vec3(-0.01, -0.01, -0.01);
  EXPECT_GT(cache.get(*hull)->models().surfaces[0].distance->signedDistance(corner_of_first), 1e-4);
  hull->~btConvexHullShape();
}

std::string saidOf(btCollisionShape& shape) {
  World world;
  world.addShape(shape, 0, Vec3::Zero(), Pose());
  world.add(cube(), Pose());
  testing::internal::CaptureStderr();
  world.step(3);
  return testing::internal::GetCapturedStderr();
}

TEST(NativeShapes, ThatCannotCollideAreRefusedInWordsOnce) {
  btGImpactCompoundShape gimpact;
  btBoxShape box(at(0.01, 0.01, 0.01));
  gimpact.addChildShape(btTransform::getIdentity(), &box);
  gimpact.updateBound();
  btConvex2dShape flat(&box);
  btConvexHullShape line;
  line.addPoint(at(0, 0, 0));
  line.addPoint(at(0.01, 0, 0));
  btConvexHullShape broken;
  for (const btVector3& p : slabCorners(0.01, -0.01, 0.01)) broken.addPoint(p);
  broken.getUnscaledPoints()[3].setX(std::numeric_limits<btScalar>::quiet_NaN());
  struct Nothing : OwnConcave {  // as a btSdfCollisionShape, which has no triangles either
    void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {}
  } nothing;
  struct TooMuch : OwnConcave {
    void processAllTriangles(btTriangleCallback* visit, const btVector3&, const btVector3&) const override {
      btVector3 corners[3] = {at(0, 0, 0), at(0.01, 0, 0), at(0, 0.01, 0)};
      for (std::size_t i = 0; i <= kMaxNativeTriangles; ++i) visit->processTriangle(corners, 0, 0);
    }
  } too_much;
  Ground ground;
  const btConcaveShape* extent = &ground.keep<btBvhTriangleMeshShape>(&slabMesh(ground), true);
  nothing.other = too_much.other = extent;
  for (const auto& [shape, words] :
       std::initializer_list<std::pair<btCollisionShape*, const char*>>{{&gimpact, "btCompoundShape"},
                                                                        {&flat, "two dimensions"},
                                                                        {&line, "fewer than three corners"},
                                                                        {&broken, "not a number"},
                                                                        {&nothing, "names no triangles"},
                                                                        {&too_much, "split it"}}) {
    const std::string said = saidOf(*shape);
    EXPECT_NE(said.find("do not collide"), std::string::npos) << shape->getName();
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(said.find("do not collide"), said.rfind("do not collide")) << "once is enough";
  }
}

TEST(NativeShapes, AnEmptyShapeMeansNothingAndSaysNothing) {
  btEmptyShape empty;
  EXPECT_EQ(saidOf(empty), "");
}

INSTANTIATE_TEST_SUITE_P(Rows, NativeShapeAdapter, testing::ValuesIn(rows()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace vps::bullet
