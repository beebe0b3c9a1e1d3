// SPDX-License-Identifier: BSD-3-Clause
// A world with parts is saved in Bullet's format and loaded again: by our importer, and by Bullet's own.
#include <LinearMath/btSerializer.h>
#include <gtest/gtest.h>

#include <vector>

#include "bullet_bridge/world.h"
#include "vps/errors.h"
#include "vps_bullet/world_importer.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::World;

const Built& tube() {
  static const Built built = test::build(makeTube(0.012, 0.006, 0.01, 24), 7850, 0.5e-3, 1e-3);
  return built;
}

std::vector<char> save(World& world) {
  btDefaultSerializer serializer;
  world.world->serialize(&serializer);
  const auto* bytes = reinterpret_cast<const char*>(serializer.getBufferPointer());
  return {bytes, bytes + serializer.getCurrentBufferSize()};
}

/// A fixed plate, a tube that falls on it, and one of Bullet's boxes.
void fill(World& world, btBoxShape& box) {
  world.add(test::onePlate(), Pose(), true);
  world.add(tube(), Pose(rotationFromVector(Vec3(0.1, 0.05, 0.2)), Vec3(0, 0, 0.012)));
  world.addShape(box, 0.01, Vec3(1e-7, 1e-7, 1e-7), Pose::translation(Vec3(0.02, 0, 0.02)));
}

TEST(SavedWorld, GoesOnWhereItWasSaved) {
  btBoxShape box(btVector3(toBt(0.004), toBt(0.004), toBt(0.004)));
  World first;
  fill(first, box);
  first.step(20);
  std::vector<char> file = save(first);
  const double then_z = first.bodies[1]->getWorldTransform().getOrigin().z();
  first.step(300);

  World second;
  second.world->setGravity(btVector3(0, 0, toBt(-9.81)));
  WorldImporter importer(second.world.get());
  ASSERT_TRUE(importer.loadFileFromMemory(file.data(), static_cast<int>(file.size())));
  ASSERT_EQ(importer.getNumRigidBodies(), 3);
  btRigidBody& tube_body = *btRigidBody::upcast(importer.getRigidBodyByIndex(1));
  const auto* shape = dynamic_cast<const Shape*>(tube_body.getCollisionShape());
  ASSERT_NE(shape, nullptr);
  EXPECT_NEAR(shape->models().map->voxel_m(), 0.5e-3, 1e-15);
  EXPECT_NEAR(shape->models().shell->spacing_m, tube().shape->models().shell->spacing_m, 1e-15);
  EXPECT_LT((shape->X_SM().p - tube().shape->X_SM().p).norm(), 1e-12);
  EXPECT_LT((shape->X_SM().R - tube().shape->X_SM().R).norm(), 1e-12);
  EXPECT_NE(
      dynamic_cast<const Shape*>(btRigidBody::upcast(importer.getRigidBodyByIndex(0))->getCollisionShape()),
      nullptr);
  EXPECT_EQ(btRigidBody::upcast(importer.getRigidBodyByIndex(2))->getCollisionShape()->getShapeType(),
            BOX_SHAPE_PROXYTYPE);
  EXPECT_NEAR(tube_body.getWorldTransform().getOrigin().z(), then_z, 1e-9);
  EXPECT_NEAR(1 / tube_body.getInvMass(), tube().frame.mass_kg, 1e-6 * tube().frame.mass_kg);
  for (int i = 0; i < 3; ++i)
    btRigidBody::upcast(importer.getRigidBodyByIndex(i))->setActivationState(DISABLE_DEACTIVATION);
  second.step(300);
  // The tube rests on its face, as in the world that was not saved.
  EXPECT_NEAR(tube_body.getWorldTransform().getOrigin().z(), 0.010, 5e-6);
  EXPECT_NEAR(first.bodies[1]->getWorldTransform().getOrigin().z(), 0.010, 5e-6);
  while (second.world->getNumCollisionObjects() > 0)
    second.world->removeCollisionObject(second.world->getCollisionObjectArray()[0]);
  importer.deleteAllData();
}

TEST(SavedWorld, IsReadByBulletsOwnImporterAsMeshes) {
  btBoxShape box(btVector3(toBt(0.004), toBt(0.004), toBt(0.004)));
  World world;
  fill(world, box);
  std::vector<char> file = save(world);
  btBulletWorldImporter importer(nullptr);
  ASSERT_TRUE(importer.loadFileFromMemory(file.data(), static_cast<int>(file.size())));
  ASSERT_EQ(importer.getNumRigidBodies(), 3);
  const btCollisionObject* body = importer.getRigidBodyByIndex(1);
  EXPECT_TRUE(body->getCollisionShape()->isCompound());
  EXPECT_FALSE(body->isStaticObject());
  importer.deleteAllData();
}

TEST(SavedWorld, AScaledShapeKeepsItsSize) {
  World world;
  Built cube = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 1e-3);
  cube.shape->setLocalScaling(btVector3(2, 2, 2));
  world.add(cube, Pose());
  std::vector<char> file = save(world);
  WorldImporter importer;
  ASSERT_TRUE(importer.loadFileFromMemory(file.data(), static_cast<int>(file.size())));
  ASSERT_EQ(importer.getNumRigidBodies(), 1);
  const auto* shape = dynamic_cast<const Shape*>(importer.getRigidBodyByIndex(0)->getCollisionShape());
  ASSERT_NE(shape, nullptr);
  EXPECT_LT((shape->models().mesh->vertices[0].cwiseAbs() - Vec3::Constant(0.01)).norm(), 1e-9);
  EXPECT_NEAR(shape->models().map->voxel_m(), 1e-3, 1e-12);
  importer.deleteAllData();
}

/// Saves a world with its only body, and loads both.
class LoadedBody : public testing::Test {
 protected:
  btRigidBody& saveAndLoad(World& world) {
    file_ = save(world);
    EXPECT_TRUE(importer_.loadFileFromMemory(file_.data(), static_cast<int>(file_.size())));
    EXPECT_EQ(importer_.getNumRigidBodies(), 1);
    return *btRigidBody::upcast(importer_.getRigidBodyByIndex(0));
  }
  ~LoadedBody() override { importer_.deleteAllData(); }

 private:
  std::vector<char> file_;
  WorldImporter importer_;
};

TEST_F(LoadedBody, HasItsOwnInertiaThresholdsAndMotion) {
  World world;
  world.world->setGravity(btVector3(0, 0, 0));
  btRigidBody& body = world.add(tube(), Pose());
  // Values that no shape would have.
  body.setMassProps(toBt(0.02), toBt(Vec3(1e-5, 2e-5, 3e-5)));
  body.setSleepingThresholds(toBt(1e-3), toBt(0.1));
  body.setLinearVelocity(toBt(Vec3(0.1, 0.2, 0.3)));
  body.setAngularVelocity(toBt(Vec3(1, 2, 3)));
  const btRigidBody& loaded = saveAndLoad(world);
  EXPECT_LT((fromBt(loaded.getLocalInertia()) - Vec3(1e-5, 2e-5, 3e-5)).norm(), 1e-11);
  EXPECT_NEAR(loaded.getLinearSleepingThreshold(), 1e-3, 1e-9);
  EXPECT_NEAR(loaded.getAngularSleepingThreshold(), 0.1, 1e-7);
  EXPECT_LT((fromBt(loaded.getLinearVelocity()) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-7);
  EXPECT_LT((fromBt(loaded.getAngularVelocity()) - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST_F(LoadedBody, HasThePartsOfItsCompoundAsParts) {
  // A compound of a tube, a box and an inner compound that has the same tube.
  btBoxShape box(btVector3(toBt(0.004), toBt(0.004), toBt(0.004)));
  btCompoundShape inner, outer;
  inner.addChildShape(btTransform::getIdentity(), tube().shape.get());
  outer.addChildShape(toBt(Pose::translation(Vec3(0.03, 0, 0))), tube().shape.get());
  outer.addChildShape(toBt(Pose::translation(Vec3(0, 0.03, 0))), &box);
  outer.addChildShape(toBt(Pose::translation(Vec3(0, 0, 0.03))), &inner);
  World world;
  world.addShape(outer, 0.1, Vec3(1e-5, 2e-5, 3e-5), Pose());
  const btRigidBody& loaded = saveAndLoad(world);
  EXPECT_LT((fromBt(loaded.getLocalInertia()) - Vec3(1e-5, 2e-5, 3e-5)).norm(), 1e-11);
  ASSERT_TRUE(loaded.getCollisionShape()->isCompound());
  const auto& compound = static_cast<const btCompoundShape&>(*loaded.getCollisionShape());
  ASSERT_EQ(compound.getNumChildShapes(), 3);
  const auto* first = dynamic_cast<const Shape*>(compound.getChildShape(0));
  ASSERT_NE(first, nullptr);
  EXPECT_NEAR(first->models().map->voxel_m(), 0.5e-3, 1e-15);
  EXPECT_LT((fromBt(compound.getChildTransform(0)).p - Vec3(0.03, 0, 0)).norm(), 1e-8);
  EXPECT_EQ(compound.getChildShape(1)->getShapeType(), BOX_SHAPE_PROXYTYPE);
  ASSERT_TRUE(compound.getChildShape(2)->isCompound());
  EXPECT_LT((fromBt(compound.getChildTransform(2)).p - Vec3(0, 0, 0.03)).norm(), 1e-8);
  EXPECT_EQ(static_cast<const btCompoundShape*>(compound.getChildShape(2))->getChildShape(0), first)
      << "a shape that was shared is shared";
}

TEST(RestoreShape, RefusesOtherNamesAndNumbersThatCannotBe) {
  btTriangleMesh mesh;
  mesh.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0));
  EXPECT_EQ(restoreShape("a name", mesh), nullptr);
  EXPECT_EQ(restoreShape(nullptr, mesh), nullptr);
  EXPECT_THROW((void)restoreShape("vps::bullet::Shape/1 0.1", mesh), LoadError);
  EXPECT_THROW((void)restoreShape("vps::bullet::Shape/1 -1 4 0.1 0 0 0 1 0 0 0", mesh), LoadError);
  EXPECT_THROW((void)restoreShape("vps::bullet::Shape/1 0.1 4 0.1 0 0 0 9 0 0 0", mesh), LoadError);
}

TEST(MeshOf, RefusesAMeshWithoutTriangles) {
  btTriangleMesh mesh;
  EXPECT_THROW((void)meshOf(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace vps::bullet
