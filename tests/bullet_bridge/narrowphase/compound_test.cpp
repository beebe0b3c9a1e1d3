// SPDX-License-Identifier: BSD-3-Clause
// A compound that contains parts collides as its children would on their own.
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "bullet_bridge/world.h"
#include "solver/contact_stores.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::placesAfter;
using test::SolverKind;
using test::World;

const Built& largeCube() {
  static const Built built = test::build(makeBox(Vec3::Constant(0.02)), 7850, 0.5e-3, 1e-3);
  return built;
}
const Built& slab() {
  static const Built built = test::build(makeBox(Vec3(0.2, 0.2, 0.02)), 7850, 1e-3, 2e-3);
  return built;
}

btVector3 halfSize(const Vec3& size_m) {
  return toBt(Vec3(0.5 * size_m));
}

/// A compound of one child, or a compound of such a compound.
struct Nested {
  btCompoundShape inner, outer;
  Nested(btCollisionShape& child, bool is_twice) {
    inner.addChildShape(toBt(Pose::translation(Vec3(0, 0, 0.01))), &child);
    outer.addChildShape(toBt(Pose::translation(Vec3(0, 0, -0.01))), &inner);
    if (!is_twice) inner.updateChildTransform(0, btTransform::getIdentity());
    shape = is_twice ? &outer : &inner;
  }
  btCompoundShape* shape;
};

// The solver's residual, as for parts alone (rest_test.cpp). assumed in single precision.
constexpr double kRest_m = test::kIsDouble ? 2e-6 : 2e-5;

struct Fall {
  double deepest_m = -1, rest_m = 0;
};

/// Drops a body whose lower face is 10 mm below its origin from 0.1 m on a floor whose upper face is at 0.
Fall dropped(btCollisionShape& falling, btCollisionShape& floor, double dt_s, SolverKind solver) {
  World world(solver);
  world.addShape(floor, 0, Vec3::Zero(), Pose::translation(Vec3(0, 0, -0.01)));
  btRigidBody& body =
      world.addShape(falling, 0.06, Vec3::Constant(4e-6), Pose::translation(Vec3(0.003, 0.002, 0.11)));
  Fall fall;
  for (double t_s = 0; t_s < 0.5; t_s += dt_s) {
    world.step(1, dt_s);
    fall.rest_m = body.getWorldTransform().getOrigin().z() - 0.01;
    fall.deepest_m = std::max(fall.deepest_m, -fall.rest_m);
  }
  return fall;
}

// The body arrives at 1.4 m/s, which is 1.4 mm per step at 1 kHz and 23 mm at 60 Hz. Contact is found ahead
// of the motion, as without a compound.
TEST(Compound, StopsAFallingPartAtItsSurface) {
  btBoxShape box(halfSize(Vec3(0.2, 0.2, 0.02)));
  for (const double dt_s : {1e-3, 1.0 / 60})
    for (const SolverKind solver : {SolverKind::Stock, SolverKind::Constraint})
      for (btCollisionShape* child : std::initializer_list<btCollisionShape*>{&box, slab().shape.get()})
        for (const bool is_twice : {false, true}) {
          Nested floor(*child, is_twice);
          const Fall fall = dropped(*largeCube().shape, *floor.shape, dt_s, solver);
          EXPECT_LT(fall.deepest_m, kRest_m) << child->getName() << dt_s << is_twice;
          EXPECT_NEAR(fall.rest_m, 0, kRest_m) << child->getName() << dt_s << is_twice;
        }
}

TEST(Compound, OfPartsStopsAtTheSurfaceOfEverythingElse) {
  btBoxShape box(halfSize(Vec3(0.2, 0.2, 0.02)));
  btStaticPlaneShape plane(btVector3(0, 0, 1), toBt(0.01));
  Nested boxes(box, false), slabs(*slab().shape, true);
  for (const double dt_s : {1e-3, 1.0 / 60})
    for (const SolverKind solver : {SolverKind::Stock, SolverKind::Constraint})
      for (btCollisionShape* floor : std::initializer_list<btCollisionShape*>{
               &box, &plane, slab().shape.get(), boxes.shape, slabs.shape})
        for (const bool is_twice : {false, true}) {
          Nested falling(*largeCube().shape, is_twice);
          const Fall fall = dropped(*falling.shape, *floor, dt_s, solver);
          EXPECT_LT(fall.deepest_m, kRest_m) << floor->getName() << dt_s << is_twice;
          EXPECT_NEAR(fall.rest_m, 0, kRest_m) << floor->getName() << dt_s << is_twice;
        }
}

TEST(Compound, FollowsChildrenThatAreAddedMovedAndRemoved) {
  World world(SolverKind::Stock);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  world.addShape(plane, 0, Vec3::Zero(), Pose());
  btCompoundShape compound;
  compound.addChildShape(btTransform::getIdentity(), largeCube().shape.get());
  btRigidBody& body =
      world.addShape(compound, 0.06, Vec3::Constant(4e-6), Pose::translation(Vec3(0, 0, 0.01)));
  body.setAngularFactor(0);
  const auto height_m = [&](int steps) {
    world.step(steps);
    return body.getWorldTransform().getOrigin().z();
  };
  EXPECT_NEAR(height_m(50), 0.01, kRest_m);
  compound.updateChildTransform(0, toBt(Pose::translation(Vec3(0, 0, 0.005))));
  EXPECT_NEAR(height_m(200), 0.005, kRest_m);
  const auto second = std::make_unique<btBoxShape>(halfSize(Vec3::Constant(0.02)));
  compound.addChildShape(toBt(Pose::translation(Vec3(0.04, 0, 0.005))), second.get());
  compound.removeChildShape(largeCube().shape.get());
  EXPECT_NEAR(height_m(200), 0.005, 1e-4);  // one of Bullet's boxes
  compound.removeChildShape(second.get());
  EXPECT_LT(height_m(100), -0.02);
}

struct Nearest : btCollisionWorld::ContactResultCallback {
  double distance_m = 1e30;
  int child = -1;
  explicit Nearest(double threshold_m) { m_closestDistanceThreshold = toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper* b, int, int) override {
    if (point.m_distance1 >= distance_m) return 0;
    distance_m = point.m_distance1;
    child = a->getCollisionObject()->getCollisionShape()->isCompound() ? a->m_index : b->m_index;
    return 0;
  }
};

TEST(Compound, AnswersQueriesWithTheChildThatIsNearest) {
  World world;
  btCompoundShape compound;
  for (const double x : {-0.1, 0.0, 0.1})
    compound.addChildShape(toBt(Pose::translation(Vec3(x, 0, 0))), largeCube().shape.get());
  btRigidBody& row = world.addShape(compound, 0, Vec3::Zero(), Pose());
  for (const double gap_m : {1e-3, 15e-3})
    for (const int child : {0, 1, 2}) {
      btRigidBody& body = world.add(largeCube(), Pose::translation(Vec3(0.1 * (child - 1), 0, 0.02 + gap_m)));
      Nearest near(2 * gap_m), reverse(2 * gap_m), out_of_reach(0.5 * gap_m);
      world.world->contactPairTest(&row, &body, near);
      world.world->contactPairTest(&body, &row, reverse);
      world.world->contactPairTest(&row, &body, out_of_reach);
      EXPECT_NEAR(near.distance_m, gap_m, 1e-6);
      EXPECT_NEAR(reverse.distance_m, gap_m, 1e-6);
      EXPECT_EQ(out_of_reach.distance_m, 1e30);
      EXPECT_EQ(near.child, child);
      EXPECT_EQ(reverse.child, child);
    }
}

TEST(Compound, AsksBulletsCallbackForEachPairOfChildren) {
  btBoxShape box(halfSize(Vec3(0.2, 0.2, 0.02)));
  Nested floor(box, false);
  gCompoundChildShapePairCallback = [](const btCollisionShape*, const btCollisionShape*) { return false; };
  const Fall fall = dropped(*largeCube().shape, *floor.shape, 1e-3, SolverKind::Stock);
  gCompoundChildShapePairCallback = nullptr;
  EXPECT_GT(fall.deepest_m, 0.5);
}

// Compounds of Bullet's own shapes keep their bit-identical contact and the functions that were registered
// before install().
TEST(Compound, WithoutPartsIsLeftToBullet) {
  btBoxShape box(halfSize(Vec3::Constant(0.02)));
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  Nested pair(box, true);
  const auto placesWith = [&](bool is_installed) {
    World world(SolverKind::Stock);
    if (!is_installed) uninstall(world.dispatcher);
    world.addShape(plane, 0, Vec3::Zero(), Pose());
    for (const double z : {0.02, 0.05})
      world.addShape(*pair.shape, 0.06, Vec3::Constant(4e-6), Pose::translation(Vec3(0.1 * z, 0, z)));
    return placesAfter(world, 300);
  };
  const auto with = placesWith(true), without = placesWith(false);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_TRUE(with[i] == without[i]) << i;

  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  constexpr int kCompound = COMPOUND_SHAPE_PROXYTYPE, kBox = BOX_SHAPE_PROXYTYPE;
  btCollisionAlgorithmCreateFunc* const before = DispatchTable::contact(dispatcher)[kCompound][kBox];
  install(dispatcher);
  install(dispatcher);
  EXPECT_NE(DispatchTable::contact(dispatcher)[kCompound][kBox], before);
  uninstall(dispatcher);
  EXPECT_EQ(DispatchTable::contact(dispatcher)[kCompound][kBox], before);
  EXPECT_EQ(DispatchTable::closest(dispatcher)[kCompound][kBox], before);
}

}  // namespace
}  // namespace vps::bullet
