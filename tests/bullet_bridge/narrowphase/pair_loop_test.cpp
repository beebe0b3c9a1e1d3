// SPDX-License-Identifier: BSD-3-Clause
// Worlds with Bullet's own solvers: each pair checks its step alone, before the world is solved.
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bullet_bridge/world.h"
#include "search/prism.h"
#include "support/random_draw.h"
#include "vps/feature_motion.h"
#include "vps/mesh_overlap.h"

namespace vps::bullet {
namespace {

using search::Polygon;
using test::build;
using test::Built;
using test::SolverKind;
using test::World;

/// Tolerance: the overlap that bullet::Solver may leave after an impact, half of the contact margin. A pair
/// tolerates 1 um; the rest is the error of the solver's velocities in a step of 1 ms.
constexpr double kPairBound_m = 10e-6;

enum class Stock { Impulses, Mlcp };

class PairLoop : public testing::TestWithParam<Stock> {
 protected:
  /// A world of this test's solver.
  struct StockWorld {
    btDantzigSolver dantzig;
    btMLCPSolver mlcp{&dantzig};
    World world{SolverKind::Stock};

    explicit StockWorld(Stock solver) {
      if (solver == Stock::Mlcp) world.world->setConstraintSolver(&mlcp);
    }
  };
};

INSTANTIATE_TEST_SUITE_P(Each, PairLoop, testing::Values(Stock::Impulses, Stock::Mlcp), [](const auto& info) {
  return std::string(info.param == Stock::Impulses ? "Impulses" : "Mlcp");
});

const Built& tetrahedron() {
  static const Built built = build(
      test::centered(search::makeTetrahedron(Vec3::Zero(), {13e-3, 0, 0}, {0, 13e-3, 0}, {0, 0, 13e-3})),
      7850, 0.5e-3, 1e-3);
  return built;
}

/// A block with a step of two thirds of its height, and sharp edges all along it.
const Built& stair() {
  static const Built built =
      build(test::centered(search::makePrism(
                Polygon{{-20e-3, 0}, {20e-3, 0}, {20e-3, 4e-3}, {1e-3, 4e-3}, {1e-3, 12e-3}, {-20e-3, 12e-3}},
                {}, 0, 40e-3)),
            7850, 0.5e-3, 1e-3);
  return built;
}

/// A body turns by less than this in a step of 1 ms; contacts hold up to 0.1.
constexpr double kTurn_rad = 0.08;

/// Deepest overlap after any step of a body that is thrown at a fixed body, as long as it does not turn too
/// fast.
double deepest_m(World& world, const Built& fixed, const Built& thrown, const Pose& X_WP, const Vec3& v,
                 const Vec3& w) {
  world.add(fixed, Pose(), true);
  btRigidBody& body = world.add(thrown, X_WP);
  body.setLinearVelocity(toBt(v));
  body.setAngularVelocity(toBt(w));
  const OverlapMesh a(fixed.exact), b(thrown.exact);
  double deepest = 0;
  for (int step = 0; step < 120; ++step) {
    world.step();
    if (fromBt(body.getAngularVelocity()).norm() * 1e-3 > kTurn_rad) break;
    deepest = std::max(deepest, deepestOverlap(a, Pose(), b, test::partPose(body, thrown)).depth_m);
  }
  return deepest;
}

// Corners and edges that turn at up to 50 rad/s and fly at up to 0.8 m/s meet faces and edges. One body
// slides over the end of an edge in a step that bends by 32 um; since the next edge is found there, that body
// later ends a step 15 to 16 um deep, for an unknown reason.
TEST_P(PairLoop, FindsTheCornersAndEdgesOfAThrownBody) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal;
  int deeper = 0;
  for (int i = 0; i < 100; ++i) {
    StockWorld stock(GetParam());
    const Mat3 R(test::drawnRotation(normal, random));
    const Vec3 v = test::drawnVector(normal, random).normalized() * (0.5 + 0.3 * uniform(random));
    const Vec3 w = test::drawnVector(normal, random).normalized() * 50 * uniform(random);
    const Pose X_WP(R, -38e-3 * v.normalized());
    const double depth_m = deepest_m(stock.world, stair(), tetrahedron(), X_WP, v, w);
    EXPECT_LE(depth_m, 2 * kPairBound_m) << "body " << i;
    deeper += depth_m > kPairBound_m;
  }
  EXPECT_LE(deeper, 1);
}

/// All contacts of a world.
std::vector<btManifoldPoint> contactsOf(const World& world) {
  std::vector<btManifoldPoint> contacts;
  for (int m = 0; m < world.dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i) contacts.push_back(manifold.getContactPoint(i));
  }
  return contacts;
}

double gap_m(const btManifoldPoint& point) {
  return point.m_normalWorldOnB.dot(point.getPositionWorldOnA() - point.getPositionWorldOnB());
}

TEST_P(PairLoop, LeavesBodiesAndImpulsesAsTheyWere) {
  StockWorld stock(GetParam());
  World& world = stock.world;
  const Built box = test::steelBox(), ground = test::plate();
  world.add(ground, Pose::translation({0, 0, -5e-3}), true);
  btRigidBody& body = world.add(box, Pose::translation({0, 0, 5e-3}));
  world.step(100);
  const std::vector<btManifoldPoint> before = contactsOf(world);
  const btTransform X_WB = body.getWorldTransform();
  const btVector3 v = body.getLinearVelocity(), w = body.getAngularVelocity();
  // Without gravity, which the step has used up, the pair alone carries no load.
  world.world->performDiscreteCollisionDetection();
  const std::vector<btManifoldPoint> after = contactsOf(world);
  ASSERT_EQ(after.size(), before.size());
  btScalar load_Ns = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].m_appliedImpulse, before[i].m_appliedImpulse) << i;
    EXPECT_EQ(after[i].m_appliedImpulseLateral1, before[i].m_appliedImpulseLateral1) << i;
    EXPECT_EQ(after[i].m_appliedImpulseLateral2, before[i].m_appliedImpulseLateral2) << i;
    load_Ns += after[i].m_appliedImpulse;
  }
  EXPECT_GT(load_Ns, 0.9 * box.frame.mass_kg * test::kGravity * 1e-3);
  EXPECT_TRUE(body.getWorldTransform() == X_WB);
  EXPECT_EQ(body.getLinearVelocity(), v);
  EXPECT_EQ(body.getAngularVelocity(), w);
}

/// A box begins 5 um above a plate. Returns, for the first step of a world, the least distance that the
/// solver gets, minus the gap.
double distanceLessGap_m(World& world, const Vec3& angular_factor = Vec3::Ones()) {
  static const Built box = test::steelBox(), ground = test::plate();
  world.add(ground, Pose::translation({0, 0, -5e-3}), true);
  btRigidBody& body = world.add(box, Pose::translation({0, 0, 5e-3 + 5e-6}));
  body.setAngularFactor(toBt(angular_factor));
  world.step();
  double least_m = 1;
  for (const btManifoldPoint& point : contactsOf(world))
    least_m = std::min<double>(least_m, static_cast<double>(point.getDistance()) - gap_m(point));
  return least_m;
}

// Bullet's solvers get distances that are reduced by the rest gap, which bullet::Solver reads separately. The
// reduction is the same in the first step, and for bodies that bullet::Solver passes to Bullet's solver.
TEST_P(PairLoop, GivesBulletsSolversTheRestGap) {
  constexpr double kRest_m = FeatureMotion::kRest_m;
  StockWorld stock(GetParam());
  EXPECT_NEAR(distanceLessGap_m(stock.world), -kRest_m, 1e-9);
  World own(SolverKind::Constraint), held(SolverKind::Constraint);
  EXPECT_NEAR(distanceLessGap_m(own), 0, 1e-9);
  EXPECT_NEAR(distanceLessGap_m(held, Vec3::Zero()), -kRest_m, 1e-9);
}

}  // namespace
}  // namespace vps::bullet
