// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/shape.h"

#include <gtest/gtest.h>

#include "bullet_bridge/world.h"
#include "vps/load_error.h"

namespace vps {
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

TEST(VpsShape, IsAConcaveTypeThatNobodyElseClaims) {
  const VpsShape shape(VpsModels{});
  EXPECT_EQ(shape.getShapeType(), FAST_CONCAVE_MESH_PROXYTYPE);
  EXPECT_TRUE(shape.isConcave());
  EXPECT_EQ(shape.getMargin(), 0);
}

TEST(VpsShape, ItsBoxFollowsItsPose) {
  VpsModels models;
  models.mesh = std::make_shared<const Mesh>(makeBox(Vec3(0.02, 0.04, 0.06)));
  const VpsShape shape(models);
  const Mat3 R = rotationFromVector(Vec3(0, 0, 1.5707963267948966));  // x and y change places
  btVector3 min, max;
  shape.getAabb(toBt(Pose(R, Vec3(1, 2, 3))), min, max);
  EXPECT_LE((fromBt(max - min) - Vec3(0.04, 0.02, 0.06)).norm(), 1e-6);
  EXPECT_LE((fromBt(max + min) / 2 - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST(VpsShape, ItsInertiaIsThatOfTheSolid) {
  VpsModels models;
  models.mesh = std::make_shared<const Mesh>(makeBox(Vec3(0.02, 0.04, 0.06)));
  btVector3 inertia;
  VpsShape(models).calculateLocalInertia(3, inertia);
  EXPECT_LE((fromBt(inertia) -
             Vec3(0.04 * 0.04 + 0.06 * 0.06, 0.02 * 0.02 + 0.06 * 0.06, 0.02 * 0.02 + 0.04 * 0.04) / 4)
                .norm(),
            1e-8);
}

TEST(VpsShape, RefusesScaleAndMargin) {
  VpsShape shape(VpsModels{});
  testing::internal::CaptureStderr();
  shape.setLocalScaling(btVector3(2, 2, 2));
  shape.setMargin(toBt(0.01));
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("cannot be scaled"), std::string::npos);
  EXPECT_NE(said.find("no margin"), std::string::npos);
  EXPECT_EQ(shape.getLocalScaling(), btVector3(1, 1, 1));
  EXPECT_EQ(shape.getMargin(), 0);
}

TEST(VpsShape, ARayHitsItWhereItIs) {
  World world;
  VpsModels models;
  models.mesh = std::make_shared<const Mesh>(makeTube(0.01, 0.005, 0.02, 64));
  VpsShape shape(models);
  world.addShape(shape, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, 0.1)));
  const auto cast = [&](const Vec3& from, const Vec3& to) {
    btCollisionWorld::ClosestRayResultCallback hit(toBt(from), toBt(to));
    world.world->rayTest(toBt(from), toBt(to), hit);
    return hit.hasHit() ? fromBt(hit.m_hitPointWorld) : Vec3(9, 9, 9);
  };
  EXPECT_LE((cast(Vec3(0.0075, 0, 1), Vec3(0.0075, 0, -1)) - Vec3(0.0075, 0, 0.11)).norm(), 1e-6);
  EXPECT_EQ(cast(Vec3(0, 0, 1), Vec3(0, 0, -1)).x(), 9) << "through the hole";
}

TEST(VpsShape, GivesAllTrianglesOfABoxAndNoOthers) {
  VpsModels models;
  models.mesh = std::make_shared<const Mesh>(makeSphere(0.01, 3));
  const VpsShape shape(models);
  struct Counter : btTriangleCallback {
    int count = 0;
    void processTriangle(btVector3*, int, int) override { ++count; }
  } all, half, none;
  shape.processAllTriangles(&all, btVector3(-1, -1, -1), btVector3(1, 1, 1));
  shape.processAllTriangles(&half, btVector3(toBt(1e-4), -1, -1), btVector3(1, 1, 1));
  shape.processAllTriangles(&none, btVector3(toBt(0.011), -1, -1), btVector3(1, 1, 1));
  EXPECT_EQ(all.count, 20 * 64);
  EXPECT_NEAR(half.count, 640, 64);  // the half, and the belt that straddles it
  EXPECT_EQ(none.count, 0);
}

TEST(VpsShape, TellsEdgePointsFromFacePoints) {
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 1000, 0.5e-3, 1e-3);
  const PointShell& shell = *box.shape->models().shell;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    // On the box's surface; on an edge if two coordinates are at their limit.
    const int at_limit = static_cast<int>((shell.points[id].cwiseAbs().array() > 0.005 - 1e-9).count());
    EXPECT_EQ(box.shape->isEdgePoint(id), at_limit >= 2) << shell.points[id].transpose();
  }
}

TEST(VpsShape, ReplacedModelsInheritNoImpulses) {
  World world;
  const Built box = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  Built plate = test::build(makeBox(Vec3(0.04, 0.04, 0.010)), 7850, 0.5e-3, 1e-3);
  world.addShape(*plate.shape, 0, Vec3::Zero(), plate.frame.X_PB);
  world.add(box, Pose::translation(Vec3(0, 0, 0.010)));
  // A point that stays a contact gets older and starts with the impulse it had.
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

TEST(VpsShape, ReplacedModelsTakeEffectAtTheNextStep) {
  // A box on a cooked plate; the plate gets a step that is 1 mm higher: the box comes up with it, gently.
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
}  // namespace vps
