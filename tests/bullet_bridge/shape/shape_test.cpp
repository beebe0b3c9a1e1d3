// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "bullet_bridge/world.h"
#include "support/lathe.h"
#include "vps/errors.h"
#include "vps/feature_motion.h"
#include "vps/query.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::World;

constexpr double kRounding_m = sizeof(btScalar) == 8 ? 1e-12 : 1e-7;

TEST(BodyFrame, OfAnOffsetBoxHasItsAnalyticInertia) {
  const Vec3 size(0.02, 0.03, 0.04);
  const Pose X_PM(rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.1, 0.2, 0.3));
  const BodyFrame frame = makeBodyFrame(massProperties(transformed(makeBox(size), X_PM)), 1000);
  const double m = 1000 * size.prod();
  EXPECT_NEAR(frame.mass_kg, m, 1e-12);
  EXPECT_LE((frame.X_PB.p - X_PM.p).norm(), 1e-12);
  EXPECT_NEAR(frame.X_PB.R.determinant(), 1, 1e-12);
  const Vec3 s2 = size.cwiseAbs2() * (m / 12);
  Vec3 expected(s2.x() + s2.y(), s2.x() + s2.z(), s2.y() + s2.z());  // ascending, as eigenvalues are
  EXPECT_LE((frame.inertia_kg_m2 - expected).norm(), 1e-14);
}

TEST(BodyFrame, RefusesAnInsideOutMesh) {
  MassProperties inside_out;
  inside_out.volume_m3 = -1;
  EXPECT_THROW(makeBodyFrame(inside_out, 1000), LoadError);
  inside_out.volume_m3 = 1;
  EXPECT_THROW(makeBodyFrame(inside_out, 0), LoadError);
}

TEST(Shape, HasAConcaveTypeThatBulletDoesNotUse) {
  const Shape shape(test::boxMesh());
  EXPECT_EQ(shape.getShapeType(), FAST_CONCAVE_MESH_PROXYTYPE);
  EXPECT_TRUE(shape.isConcave());
  EXPECT_EQ(shape.getMargin(), 0);
}

TEST(Shape, ItsBoxFollowsItsPose) {
  ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeBox(Vec3(0.02, 0.04, 0.06)));
  const Shape shape(models);
  const Mat3 R = rotationFromVector(Vec3(0, 0, 1.5707963267948966));  // exchanges x and y
  btVector3 min, max;
  shape.getAabb(toBt(Pose(R, Vec3(1, 2, 3))), min, max);
  const Vec3 with_gap = Vec3(0.04, 0.02, 0.06) + Vec3::Constant(4 * FeatureMotion::kRest_m);
  EXPECT_LE((fromBt(max - min) - with_gap).norm(), sizeof(btScalar) == 4 ? 1e-6 : 1e-12);  // rounding at 3 m
  EXPECT_LE((fromBt(max + min) / 2 - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST(Shape, ItsInertiaIsThatOfTheSolid) {
  ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeBox(Vec3(0.02, 0.04, 0.06)));
  btVector3 inertia;
  Shape(models).calculateLocalInertia(3, inertia);
  EXPECT_LE((fromBt(inertia) -
             Vec3(0.04 * 0.04 + 0.06 * 0.06, 0.02 * 0.02 + 0.06 * 0.06, 0.02 * 0.02 + 0.04 * 0.04) / 4)
                .norm(),
            1e-8);
}

// Message of the std::invalid_argument that `call` throws; empty if it throws none.
template <typename Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return "";
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Shape, RefusesAMargin) {
  Shape shape(test::boxMesh());
  testing::internal::CaptureStderr();
  shape.setMargin(toBt(0.01));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("has no effect"), std::string::npos);
  EXPECT_EQ(shape.getMargin(), 0);
  for (const double margin : {-1.0, kNan})
    EXPECT_NE(refusalOf([&] { shape.setMargin(toBt(margin)); }).find("margin"), std::string::npos);
}

TEST(Shape, RefusesEmptyModelsAndPosesThatAreNotFinite) {
  EXPECT_NE(refusalOf([] { Shape shape(ShapeModels{}); }).find("no models"), std::string::npos);
  EXPECT_NE(refusalOf([] { Shape shape(test::boxMesh(), Pose::translation(Vec3(0, kNan, 0))); }).find("X_SM"),
            std::string::npos);
  Shape shape(test::boxMesh());
  EXPECT_NE(refusalOf([&] { shape.setModels(ShapeModels{}); }).find("no models"), std::string::npos);
  EXPECT_TRUE(shape.models().mesh) << "it is as it was";
}

TEST(Shape, RefusesAMassThatIsNegativeOrNotFinite) {
  const Shape shape(test::boxMesh());
  btVector3 inertia(1, 1, 1);
  for (const double mass : {-1.0, kNan, std::numeric_limits<double>::infinity()})
    EXPECT_NE(refusalOf([&] { shape.calculateLocalInertia(toBt(mass), inertia); }).find("mass"),
              std::string::npos)
        << mass;
  shape.calculateLocalInertia(0, inertia);
  EXPECT_EQ(inertia, btVector3(0, 0, 0)) << "fixed";
}

TEST(Shape, RefusesScalesThatAreNotOnePositiveNumber) {
  Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  const auto is_refused = [&](double x, double y, double z) {
    return !refusalOf([&] { box.shape->setLocalScaling(btVector3(toBt(x), toBt(y), toBt(z))); }).empty();
  };
  EXPECT_TRUE(is_refused(1, 2, 1));
  EXPECT_TRUE(is_refused(0, 0, 0));
  EXPECT_TRUE(is_refused(-1, -1, -1));
  EXPECT_TRUE(is_refused(kNan, kNan, kNan));
  EXPECT_TRUE(is_refused(HUGE_VAL, HUGE_VAL, HUGE_VAL));
  EXPECT_EQ(box.shape->getLocalScaling(), btVector3(1, 1, 1)) << "it is as it was";
  ShapeModels only_a_map;
  only_a_map.map = box.shape->models().map;
  Shape shape(only_a_map);
  EXPECT_NE(refusalOf([&] { shape.setLocalScaling(btVector3(2, 2, 2)); }).find("mesh"), std::string::npos);
}

TEST(Shape, ScaledItEqualsThePartOfThatSize) {
  Built scaled = test::build(makeTube(0.01, 0.005, 0.02, 32), 1000, 0.5e-3, 1e-3);
  const Built large = test::build(makeTube(0.02, 0.01, 0.04, 32), 1000, 1e-3, 2e-3);
  scaled.shape->setLocalScaling(btVector3(2, 2, 2));
  EXPECT_EQ(scaled.shape->getLocalScaling(), btVector3(2, 2, 2));
  const ShapeModels &a = scaled.shape->models(), &b = large.shape->models();
  EXPECT_LE((scaled.shape->bounds().max - large.shape->bounds().max).norm(), 1e-9);
  ASSERT_EQ(a.shell->size(), b.shell->size());
  double area_m2 = 0;
  for (std::size_t i = 0; i < a.shell->size(); ++i) {
    // Each scaled point lies on the exact surface of the larger part, whose field has an error that depends
    // on the voxel.
    EXPECT_LE(std::abs(b.surfaces[0].distance->signedDistance(a.shell->points[i])), 1e-9);
    area_m2 += a.shell->area_m2[i];
  }
  EXPECT_NEAR(area_m2, area(large.mesh), 1e-9);
  EXPECT_NEAR(a.map->voxel_m(), b.map->voxel_m(), 1e-12);
  EXPECT_NEAR(a.map->distance(Vec3(0.021, 0, 0)), b.map->distance(Vec3(0.021, 0, 0)), 2 * a.map->quantum_m());
  // A query that culls by blocks finds every point of the scaled shell.
  ContactSet near(a.shell->size());
  QueryOptions options;
  options.cutoff_m = 1e-3;
  EXPECT_EQ(queryContacts(*a.map, *a.shell, Pose(), options, near).points_tested, a.shell->size());
  EXPECT_EQ(near.contacts.size(), a.shell->size());
  btVector3 inertia, expected;
  scaled.shape->calculateLocalInertia(1, inertia);
  large.shape->calculateLocalInertia(1, expected);
  EXPECT_LE((inertia - expected).length(), 1e-9);
  scaled.shape->setLocalScaling(btVector3(1, 1, 1));
  EXPECT_NEAR(scaled.shape->bounds().max.x(), 0.5 * large.shape->bounds().max.x(), 1e-9);
  EXPECT_EQ(scaled.shape->models().surfaces.size(), 1u);
}

TEST(Shape, ScaledInContactItRestsAtItsNewHeight) {
  World world;
  Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  world.step(50);
  box.shape->setLocalScaling(btVector3(toBt(0.5), toBt(0.5), toBt(0.5)));
  world.step(200);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.0025, 1e-6);
  // A compound scales its children.
  btCompoundShape compound;
  compound.addChildShape(btTransform::getIdentity(), box.shape.get());
  compound.setLocalScaling(btVector3(2, 2, 2));
  EXPECT_NEAR(box.shape->bounds().max.z(), 0.005, 1e-9);
}

TEST(Shape, ReplacedModelsAreScaledAsTheShapeIs) {
  Shape shape(test::boxMesh());
  shape.setLocalScaling(btVector3(3, 3, 3));
  shape.setModels(test::boxMesh());
  EXPECT_LE((shape.bounds().size() - 3 * Vec3(0.02, 0.04, 0.06)).norm(), 1e-12);
}

TEST(Shape, WithoutMapOrShellReportsThatItHasNoContact) {
  World world;
  Shape only_mesh(test::boxMesh());
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  world.addShape(only_mesh, 1, Vec3::Ones(), Pose());
  testing::internal::CaptureStderr();
  world.step(3);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("needs a shell"), std::string::npos);
  EXPECT_EQ(said.find("needs a shell"), said.rfind("needs a shell")) << "reported more than once";
}

TEST(Shape, WithoutAMapUsesItsExactSurfaces) {
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  ShapeModels models = box.shape->models();
  models.map = nullptr;
  Shape bare(models, box.shape->X_SM());
  World world;
  world.addShape(bare, 0, Vec3::Zero(), box.frame.X_PB);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.0102)));
  world.step(300);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6);
}

TEST(Shape, GivesAllTrianglesOfABoxAndNoOthers) {
  ShapeModels models;
  models.mesh = std::make_shared<const Mesh>(makeSphere(0.01, 3));
  const Shape shape(models);
  struct Counter : btTriangleCallback {
    int count = 0;
    void processTriangle(btVector3*, int, int) override { ++count; }
  } all, half, none;
  shape.processAllTriangles(&all, btVector3(-1, -1, -1), btVector3(1, 1, 1));
  shape.processAllTriangles(&half, btVector3(toBt(1e-4), -1, -1), btVector3(1, 1, 1));
  shape.processAllTriangles(&none, btVector3(toBt(0.011), -1, -1), btVector3(1, 1, 1));
  EXPECT_EQ(all.count, 20 * 64);
  EXPECT_NEAR(half.count, 640, 64);  // the half, and the triangles across its boundary
  EXPECT_EQ(none.count, 0);
}

TEST(Shape, DistinguishesEdgePointsFromFacePoints) {
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 1000, 0.5e-3, 1e-3);
  const PointShell& shell = *box.shape->models().shell;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    // A point of the box's surface is on an edge if two of its coordinates are at their limits.
    const int at_limit = static_cast<int>((shell.points[id].cwiseAbs().array() > 0.005 - 1e-9).count());
    EXPECT_EQ(box.shape->isEdgePoint(id), at_limit >= 2) << shell.points[id].transpose();
  }
}

TEST(Shape, GivesTheNormalsOfTheCylinderBehindItsFacets) {
  constexpr double kRadius_m = 5e-3, kHeight_m = 10e-3;
  constexpr int kFacets = 64;
  const Built peg = test::build(
      test::lathe({{0, 0}, {kRadius_m, 0}, {kRadius_m, kHeight_m}, {0, kHeight_m}}, kFacets), 7850, 0.5e-3);
  const PointShell& shell = *peg.shape->models().shell;
  double facets_off_rad = 0;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    if (peg.shape->isEdgePoint(id)) continue;
    const bool is_end = shell.points[id].z() < 1e-9 || shell.points[id].z() > kHeight_m - 1e-9;
    const Vec3 radial(shell.points[id].x(), shell.points[id].y(), 0);
    const Vec3 inward = is_end ? shell.inward[id] : Vec3(-radial.normalized());
    // The normal is interpolated between the normals of two corners, linearly along the chord like the point,
    // so it is exact except for the corners' rounding to floats.
    EXPECT_LE((peg.shape->smoothInward(id) - inward).norm(), 3e-7) << shell.points[id].transpose();
    facets_off_rad = std::max(facets_off_rad, (shell.inward[id] - inward).norm());
  }
  EXPECT_GE(facets_off_rad, 0.9 * M_PI / kFacets);
}

TEST(Shape, ReplacedModelsInheritNoImpulses) {
  World world;
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.010)), 7850, 0.5e-3, 1e-3);
  world.addShape(*plate.shape, 0, Vec3::Zero(), plate.frame.X_PB);
  world.add(box, Pose::translation(Vec3(0, 0, 0.010)));
  // A point that stays a contact increases its lifetime and keeps its impulse.
  const auto oldest = [&] {
    int steps = 0;
    for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m)
      for (int i = 0; i < world.dispatcher.getManifoldByIndexInternal(m)->getNumContacts(); ++i)
        steps =
            std::max(steps, world.dispatcher.getManifoldByIndexInternal(m)->getContactPoint(i).getLifeTime());
    return steps;
  };
  world.step(10);
  EXPECT_GE(oldest(), 5);
  plate.shape->setModels(plate.shape->models());
  world.step();
  ASSERT_GT(world.dispatcher.getNumManifolds(), 0);
  EXPECT_EQ(oldest(), 0);
  world.step();
  EXPECT_EQ(oldest(), 1);
}

TEST(Shape, ReplacedModelsTakeEffectAtTheNextStep) {
  // A box on a merged plate; the plate receives a step 1 mm higher, and the box rises slowly.
  World world;
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  Built low = test::build(makeBox(Vec3(0.04, 0.04, 0.010)), 7850, 0.5e-3, 1e-3);
  const Built high = test::build(makeBox(Vec3(0.04, 0.04, 0.012)), 7850, 0.5e-3, 1e-3);
  world.addShape(*low.shape, 0, Vec3::Zero(), low.frame.X_PB);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.010)));
  world.step(50);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 1e-6 + kRounding_m);
  low.shape->setModels(high.shape->models());
  double speed_m_s = 0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    speed_m_s = std::max<double>(speed_m_s, body.getLinearVelocity().length());
  }
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.011, 5e-6);
  EXPECT_LE(speed_m_s, 0.06);
}

}  // namespace
}  // namespace vps::bullet
