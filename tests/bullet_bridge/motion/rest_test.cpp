// SPDX-License-Identifier: BSD-3-Clause
// Parts at rest, sliding, falling and bouncing, compared with formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bullet_bridge/world.h"
#include "vps/feature_motion.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::kGravity;
using test::kIsDouble;
using test::plate;
using test::SolverKind;
using test::steelBox;
using test::World;

// The velocity at rest is the solver's residual (1e-7 m/s by SolverSettings; about 1e-6 for 100 iterations of
// the stock solver), in single precision the rounding of dt * g.
constexpr double kRest_m_s = kIsDouble ? 1e-6 : 2e-5;

struct Rest {
  double sink_m = 0, drift_m = 0, speed_m_s = 0, spin_rad_s = 0;
};

// Lets a body come to rest for one second, then observes it for two.
Rest watch(World& world, btRigidBody& body, const Pose& X_WB_expected) {
  world.step(1000);
  Rest rest;
  const Pose start = fromBt(body.getWorldTransform());
  for (int i = 0; i < 2000; ++i) {
    world.step();
    rest.speed_m_s = std::max<double>(rest.speed_m_s, body.getLinearVelocity().length());
    rest.spin_rad_s = std::max<double>(rest.spin_rad_s, body.getAngularVelocity().length());
  }
  const Pose end = fromBt(body.getWorldTransform());
  rest.drift_m = (end.p - start.p).norm();
  rest.sink_m = std::abs(end.p.z() - X_WB_expected.p.z());
  return rest;
}

class RestWithSolver : public testing::TestWithParam<SolverKind> {};

TEST_P(RestWithSolver, ABoxOnAPlateStaysWhereItWasPlaced) {
  World world(GetParam());
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(1e-3, 2e-3, 0.005)));
  const Rest rest = watch(world, body, fromBt(body.getWorldTransform()));
  EXPECT_LE(rest.sink_m, 1e-6);
  EXPECT_LE(rest.drift_m, 1e-6);
  EXPECT_LE(rest.speed_m_s, kRest_m_s);
  EXPECT_LE(rest.spin_rad_s, kRest_m_s / 0.01);
}

// Edges of 15 degrees have no crossings and may have no shell points, so only the check of the solved step
// finds them. The edges' contacts are kept, or each step would be solved twice and its pairs searched again.
TEST(Rest, APrismAcrossTwoOthersRestsOnItsEdgesWithoutBeingSearchedAgain) {
  World world(SolverKind::Constraint);
  const Built rail = test::build(makeCylinder(0.005, 0.03, 24), 7850, 0.5e-3, 1e-3);
  const Built roller = test::build(makeCylinder(0.005, 0.04, 24), 7850, 0.5e-3, 1e-3);
  const Mat3 along_y = rotationFromVector(Vec3(std::numbers::pi / 2, 0, 0));
  const Mat3 along_x = rotationFromVector(Vec3(0, std::numbers::pi / 2, 0));
  for (const double x_m : {-0.01, 0.01}) world.add(rail, Pose(along_y, Vec3(x_m, 0, 0)), true, 0.3);
  btRigidBody& body = world.add(roller, Pose(along_x, Vec3(0, 0, 0.0101)), false, 0.3);
  world.step(1000);
  const std::size_t searched = stats(world.dispatcher).pair_updates;
  const Pose start = fromBt(body.getWorldTransform());
  world.step(1000);
  EXPECT_LE(stats(world.dispatcher).pair_updates - searched, 20u);  // of 2 pairs in 1000 steps
  EXPECT_LE((fromBt(body.getWorldTransform()).p - start.p).norm(), 1e-6);
}

TEST_P(RestWithSolver, ABoxOfAMeshThatFacesInFallsOntoAPlateAndRests) {
  Mesh inside_out = makeBox(Vec3(0.02, 0.015, 0.01));
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  World world(GetParam());
  const Built box = test::build(inside_out, 7850, 0.5e-3, 1e-3), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(1e-3, 2e-3, 0.006)));  // 1 mm above
  const Rest rest = watch(world, body, Pose::translation(Vec3(1e-3, 2e-3, 0.005)) * box.frame.X_PB);
  EXPECT_LE(rest.sink_m, 1e-6);
  EXPECT_LE(rest.drift_m, 1e-6);
  EXPECT_LE(rest.speed_m_s, kRest_m_s);
}

TEST_P(RestWithSolver, APlateWithCracksThatFacesInSupportsABox) {
  // Every second facet of the plate is split at a side where its neighbour is not, and all facets face
  // inward.
  Mesh cracked = makeBox(Vec3(0.06, 0.06, 0.01));
  for (std::size_t i = 0; i < 12; i += 2) {
    const auto [a, b, c] = cracked.triangles[i];
    const auto middle = static_cast<std::uint32_t>(cracked.vertices.size());
    cracked.vertices.push_back(0.4 * cracked.vertices[a] + 0.6 * cracked.vertices[b]);
    cracked.triangles[i] = {a, middle, c};
    cracked.triangles.push_back({middle, b, c});
  }
  for (auto& t : cracked.triangles) std::swap(t[1], t[2]);
  World world(GetParam());
  const Built box = steelBox(), ground = test::build(cracked, 7850, 0.5e-3, 1e-3);
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(1e-3, 2e-3, 0.006)));
  const Rest rest = watch(world, body, Pose::translation(Vec3(1e-3, 2e-3, 0.005)) * box.frame.X_PB);
  EXPECT_LE(rest.sink_m, 1e-6);
  EXPECT_LE(rest.drift_m, 1e-6);
  EXPECT_LE(rest.speed_m_s, kRest_m_s);
}

TEST_P(RestWithSolver, ACylinderStandsOnAPlate) {
  World world(GetParam());
  const Built cylinder = test::build(makeCylinder(0.005, 0.02, 64), 7850, 0.5e-3, 1e-3), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(cylinder, Pose::translation(Vec3(0, 0, 0.01)));
  const Rest rest = watch(world, body, fromBt(body.getWorldTransform()));
  EXPECT_LE(rest.sink_m, 1e-6);
  EXPECT_LE(rest.drift_m, 1e-6);
  EXPECT_LE(rest.speed_m_s, kRest_m_s);
}

TEST_P(RestWithSolver, ABoxRestsOnEachOfBulletsOwnShapes) {
  btBoxShape box(btVector3(0.05, 0.05, 0.01));
  btCylinderShapeZ cylinder(btVector3(0.05, 0.05, 0.01));
  btStaticPlaneShape plane(btVector3(0, 0, 1), toBt(0.01));
  for (btCollisionShape* ground : std::initializer_list<btCollisionShape*>{&box, &cylinder, &plane}) {
    World world(GetParam());
    const Built part = steelBox();
    world.addShape(*ground, 0, Vec3::Zero(), Pose());
    btRigidBody& body = world.add(part, Pose::translation(Vec3(0, 0, 0.015)));
    const Rest rest = watch(world, body, fromBt(body.getWorldTransform()));
    EXPECT_LE(rest.sink_m, 1e-6) << ground->getName();
    EXPECT_LE(rest.drift_m, 1e-6) << ground->getName();
    EXPECT_LE(rest.speed_m_s, kRest_m_s) << ground->getName();
  }
}

TEST_P(RestWithSolver, BallsAndCapsulesSupportAPlateAtTheirRadius) {
  btSphereShape ball(toBt(0.01));
  btCapsuleShapeX capsule(toBt(0.01), toBt(0.03));
  World world(GetParam());
  const Built part = plate();
  world.addShape(ball, 0, Vec3::Zero(), Pose::translation(Vec3(0.02, 0, 0)));
  world.addShape(capsule, 0, Vec3::Zero(),
                 Pose(rotationFromVector(Vec3(0, 0, 1.5707963267948966)), Vec3(-0.02, 0, 0)));
  btRigidBody& body = world.add(part, Pose::translation(Vec3(0, 0, 0.015)));
  world.step(500);
  // A round side touches the face between its points too. Penalty points stay where they are, up to half a
  // spacing (times sqrt 2) from the ball's top: s^2 / (4 r) = 25 um at 1 mm.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.015,
              GetParam() == SolverKind::Penalty ? 25e-6 : 1e-6);
}

TEST_P(RestWithSolver, SticksBelowTheFrictionAngleAndSlidesAbove) {
  // The stock solver's friction directions follow the slip, so its friction pyramid is exact in this test
  // too.
  for (const double mu : {0.15, 0.4})
    for (const double ratio : {0.97, 1.03}) {
      World world(GetParam());
      const Built box = steelBox(), ground = plate();
      const double angle_rad = std::atan(mu * ratio);
      const Mat3 R =
          rotationFromVector(Vec3(0.3, 0.95, 0).normalized() * angle_rad);  // not along the lattice
      world.add(ground, Pose(R, R * Vec3(0, 0, -0.005)), true, mu);
      btRigidBody& body = world.add(box, Pose(R, R * Vec3(0, 0, 0.005)), false, mu);
      world.step(200);
      const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
      world.step(100);
      const double moved_m = (fromBt(body.getWorldTransform().getOrigin()) - start).norm();
      if (ratio < 1) {
        EXPECT_LE(moved_m, 1e-6) << mu;
      } else {
        // a = g (sin - mu cos). The box has slid for 0.2 s, then slides for 0.1 s more: a (0.3^2 - 0.2^2)
        // / 2.
        const double a = kGravity * (std::sin(angle_rad) - mu * std::cos(angle_rad));
        // The acceleration of the box is 3 % of the deceleration by friction. The stock solver in single
        // precision has an error of 0.2 % of the friction (measured; allowed: 0.3 %), all others less than a
        // tenth of it.
        const bool is_rough = GetParam() == SolverKind::Stock && !kIsDouble;
        EXPECT_NEAR(moved_m, a * 0.05 / 2, (is_rough ? 0.1 : 0.03) * a * 0.05 / 2) << mu;
      }
    }
}

/// Sets Bullet's contact callback for the object's lifetime.
struct ScopedAddedCallback {
  explicit ScopedAddedCallback(ContactAddedCallback callback) { gContactAddedCallback = callback; }
  ~ScopedAddedCallback() { gContactAddedCallback = nullptr; }
  ScopedAddedCallback(const ScopedAddedCallback&) = delete;
  ScopedAddedCallback& operator=(const ScopedAddedCallback&) = delete;
};

// The slope is between the angles of kinetic and of static friction: a box at rest stays, and a sliding box
// continues to slide. A step without friction adds 3 mm/s at most, which must not count as sliding.
TEST_P(RestWithSolver, AFrictionModelGivesTheCoefficientAtRestAndWhileSliding) {
  constexpr double kMu = 0.3, kKinetic = 0.8 * kMu, kSpeed_m_s = 0.1;
  bullet::Settings settings;
  settings.friction_model = {"static and kinetic",
                             [](double mu, double slip_m_s) { return slip_m_s > 1e-2 ? 0.8 * mu : mu; }};
  const double angle_rad = std::atan(0.9 * kMu);
  const Mat3 R = rotationFromVector(Vec3(0, angle_rad, 0));
  const Vec3 down = R * Vec3(1, 0, 0);
  // A contact callback that leaves the coefficient alone must not keep the model from changing it.
  const ScopedAddedCallback callback([](btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                                        const btCollisionObjectWrapper*, int, int) { return false; });
  for (const auto& [slides, has_callback] :
       std::vector<std::pair<bool, bool>>{{false, false}, {true, false}, {true, true}}) {
    World world(GetParam(), settings);
    const Built box = steelBox(), ground = plate();
    world.add(ground, Pose(R, R * Vec3(0, 0, -0.005)), true, kMu);
    btRigidBody& body = world.add(box, Pose(R, R * Vec3(-0.01, 0, 0.005)), false, kMu);
    if (has_callback)
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    world.step(50);  // the contacts settle
    const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
    if (slides) body.setLinearVelocity(toBt(Vec3(kSpeed_m_s * down)));
    constexpr int kSteps = 100;
    world.step(kSteps);
    const double moved_m = (fromBt(body.getWorldTransform().getOrigin()) - start).dot(down);
    // a = g (sin - mu cos), by steps: v t + a dt^2 n (n + 1) / 2.
    const double a = kGravity * (std::sin(angle_rad) - kKinetic * std::cos(angle_rad));
    const double expected_m = slides ? kSpeed_m_s * kSteps * 1e-3 + a * 1e-6 * kSteps * (kSteps + 1) / 2 : 0;
    // As in SticksBelowTheFrictionAngleAndSlidesAbove: friction has an error of 0.3 % at most.
    const double friction_m = kGravity * kKinetic * 1e-6 * kSteps * (kSteps + 1) / 2;
    EXPECT_NEAR(moved_m, expected_m, slides ? 3e-3 * friction_m : 1e-6) << slides << has_callback;
  }
}

TEST(FrictionModels, EveryModelHasANameAndGivesTheMaterialsCoefficientAtRest) {
  for (const bullet::FrictionModel& model : bullet::kFrictionModels) {
    EXPECT_FALSE(std::string(model.name).empty());
    EXPECT_FALSE(std::string(model.description).empty()) << model.name;
    if (!model.coefficient) continue;
    EXPECT_EQ(model.coefficient(0.3, 0), 0.3) << model.name;
    for (const double slip_m_s : {1e-6, 1e-3, 1.0, 100.0}) {
      EXPECT_GE(model.coefficient(0.3, slip_m_s), 0) << model.name;
      EXPECT_LE(model.coefficient(0.3, slip_m_s), 0.3) << model.name;
    }
  }
}

TEST(FrictionModels, AModelWhoseCoefficientIsNegativeIsRefused) {
  bullet::Settings settings;
  settings.friction_model = {"negative", [](double mu, double slip_m_s) { return mu - slip_m_s; }};
  EXPECT_THROW(World(SolverKind::Constraint, settings), std::invalid_argument);
}

TEST_P(RestWithSolver, FallsFreelyUntilItTouches) {
  World world(GetParam());
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005 + 0.005)));
  world.step(30);
  // Symplectic Euler: z = g dt^2 n (n + 1) / 2, exactly.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010 - kGravity * 1e-6 * 30 * 31 / 2,
              kIsDouble ? 1e-12 : 1e-7);
  world.step(70);
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.005, 1e-6);
}

TEST_P(RestWithSolver, BouncesWithTheProductOfTheRestitutions) {
  if (GetParam() == SolverKind::Penalty) GTEST_SKIP() << "penalty contact has no restitution";
  World world(GetParam());
  const Built box = steelBox(), ground = plate();
  world.world->setGravity(btVector3(0, 0, 0));
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true).setRestitution(1);
  btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.005 + 0.0033)));
  body.setRestitution(toBt(0.5));
  body.setLinearVelocity(btVector3(0, 0, -1));
  world.step(20);
  EXPECT_NEAR(body.getLinearVelocity().z(), 0.5, 0.005);
  EXPECT_LE(body.getAngularVelocity().length(), 1e-3 * 0.5 / 0.01);
}

TEST_P(RestWithSolver, TwoFreeBodiesKeepTheirMomentum) {
  World world(GetParam());
  const Built box = steelBox();
  world.world->setGravity(btVector3(0, 0, 0));
  btRigidBody& a = world.add(box, Pose());
  btRigidBody& b = world.add(box, Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.002, 0.003, 0.02)));
  b.setLinearVelocity(btVector3(0, 0, -1));
  const double m = box.frame.mass_kg;
  const auto angular = [&](btRigidBody& body) {
    const Mat3 I = fromBt(body.getInvInertiaTensorWorld()).inverse();
    const Vec3 p = fromBt(body.getWorldTransform().getOrigin());
    return Vec3(I * fromBt(body.getAngularVelocity()) + m * p.cross(fromBt(body.getLinearVelocity())));
  };
  const Vec3 L0 = angular(a) + angular(b);
  // bullet::Solver keeps a tumbling box's angular momentum. With the stock solver Bullet's integrator keeps
  // its angular velocity instead: the rotation in a step adds I w - R' I w, with I after the step.
  Vec3 added = Vec3::Zero();
  for (int i = 0; i < 50 && a.getLinearVelocity().length() < 0.1; ++i) {
    world.step();
    if (GetParam() != SolverKind::Stock) continue;
    for (const btRigidBody* body : {&a, &b}) {
      const Vec3 w = fromBt(body->getAngularVelocity());
      const Vec3 Iw = fromBt(body->getInvInertiaTensorWorld()).inverse() * w;
      added += Iw - rotationFromVector(1e-3 * w).transpose() * Iw;
    }
  }
  EXPECT_GT(a.getLinearVelocity().length(), 0.1);  // the bodies have collided
  const Vec3 P = m * fromBt(a.getLinearVelocity() + b.getLinearVelocity());
  EXPECT_LE((P - Vec3(0, 0, -m)).norm(), (kIsDouble ? 1e-9 : 1e-5) * m);
  // bullet::Solver applies both forces in one line; the stock solver applies them at points up to a step's
  // travel (1 mm) apart, so that friction (0.15 of at most the momentum) leaves a moment.
  const double tol = GetParam() == SolverKind::Stock ? 0.15 * m * 1e-3 : (kIsDouble ? 1e-9 : 1e-5) * m * 0.01;
  EXPECT_LE((angular(a) + angular(b) - L0 - added).norm(), tol);
  const double energy_J = 0.5 * m * (a.getLinearVelocity().length2() + b.getLinearVelocity().length2());
  EXPECT_LE(energy_J, 0.5 * m * 1.0001);
}

TEST_P(RestWithSolver, AFastPartDoesNotTunnel) {
  for (const double speed_m_s : {5.0, 50.0}) {
    World world(GetParam());
    const Built box = steelBox(), ground = plate();
    world.world->setGravity(btVector3(0, 0, 0));
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
    btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.2)));
    body.setLinearVelocity(btVector3(0, 0, toBt(-speed_m_s)));
    world.step(100);
    EXPECT_GE(body.getWorldTransform().getOrigin().z(), 0.005 - 5e-6) << speed_m_s;
    EXPECT_GE(body.getLinearVelocity().z(), -1e-3) << speed_m_s;
  }
}

// A small part completely inside a large one, 8 mm from its surface, beyond the field's band.
struct Contained {
  Built block = test::build(makeBox(Vec3::Constant(0.02)), 7850, 0.5e-3, 1e-3);
  Built cube = test::build(makeBox(Vec3(0.004, 0.003, 0.005)), 7850, 0.5e-3, 1e-3);
  btRigidBody& addTo(World& world) {
    world.world->setGravity(btVector3(0, 0, 0));
    world.add(block, Pose(), true);
    return world.add(cube, Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(1e-4, 2e-4, 3e-4)));
  }
};

TEST_P(RestWithSolver, AContainedPartKeepsAFinitePose) {
  // With almost no push (20 nm a step) the part does not move, so that the second step uses the stored
  // contacts. The field has no normal at the stored contacts.
  World world(GetParam());
  Contained contained;
  btRigidBody& body = contained.addTo(world);
  world.world->getSolverInfo().m_erp2 = toBt(1e-5);
  const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
  world.step(3);
  EXPECT_LE((fromBt(body.getWorldTransform().getOrigin()) - start).norm(), 1e-6);  // false for NaN
  ASSERT_GT(world.dispatcher.getNumManifolds(), 0);
  const btPersistentManifold& contacts = *world.dispatcher.getManifoldByIndexInternal(0);
  ASSERT_GT(contacts.getNumContacts(), 0);
  for (int i = 0; i < contacts.getNumContacts(); ++i)
    EXPECT_NEAR(contacts.getContactPoint(i).m_normalWorldOnB.length(), 1, 1e-6);
}

TEST(Solver, PartsThatStartInsideEachOtherSeparateGently) {
  World world;
  Contained contained;
  btRigidBody& body = contained.addTo(world);
  for (int i = 0; i < 5; ++i) {
    const Pose before = test::partPose(body, contained.cube);
    world.step();
    const Pose after = test::partPose(body, contained.cube);
    for (const Vec3& p : contained.cube.mesh.vertices)
      EXPECT_LE((after * p - before * p).norm(), 50.1e-6) << "step " << i;  // kSeparation_m_s and rounding
  }
}

TEST(Solver, OneSweepLeavesAnErrorThatManyRemove) {
  const auto spinAfterLanding = [](int iteration_limit) {
    SolverSettings settings;
    settings.iteration_limit = iteration_limit;
    World world(SolverKind::Constraint, {}, 100, settings);
    const Built box = steelBox(), ground = plate();
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
    btRigidBody& body = world.add(box, Pose::translation(Vec3(0, 0, 0.0051)));
    body.setLinearVelocity(btVector3(0, 0, toBt(-0.1)));
    world.step(2);
    return body.getAngularVelocity().length();
  };
  EXPECT_GT(spinAfterLanding(1), 1e-2);
  EXPECT_LE(spinAfterLanding(400), kRest_m_s / 0.01);
}

// A sweep passes a load down a stack by one body at a time, so a heavy body on light ones converges slowly.
TEST(Solver, AStackWithAThousandTimesItsMassOnTopNeitherSinksNorMoves) {
  constexpr int kBoxes = 4;
  constexpr double kHeight_m = 0.01, kRatio = 1000;
  const auto worstOfStack = [=](int iteration_limit) {
    SolverSettings settings;
    settings.iteration_limit = iteration_limit;
    World world(SolverKind::Constraint, {}, 100, settings);
    const Built light = steelBox(), ground = plate();
    Built heavy = light;
    heavy.frame.mass_kg *= kRatio;
    heavy.frame.inertia_kg_m2 *= kRatio;
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
    std::vector<btRigidBody*> stack;
    for (int i = 0; i < kBoxes; ++i)
      stack.push_back(&world.add(i + 1 < kBoxes ? light : heavy,
                                 Pose::translation(Vec3(1e-4 * i, 0, kHeight_m * (i + 0.5)))));
    world.step(300);
    Rest worst;
    for (int i = 0; i < kBoxes; ++i) {
      const double z_m = stack[static_cast<std::size_t>(i)]->getWorldTransform().getOrigin().z();
      worst.sink_m = std::max(worst.sink_m, std::abs(z_m - kHeight_m * (i + 0.5)));
      worst.speed_m_s =
          std::max<double>(worst.speed_m_s, stack[static_cast<std::size_t>(i)]->getLinearVelocity().length());
    }
    return worst;
  };
  // Each box may rest at the rest gap of sharp features above the one below.
  constexpr double kGaps_m = kBoxes * FeatureMotion::kRest_m;
  EXPECT_GT(worstOfStack(30).sink_m, kGaps_m);  // only sweeps
  const Rest rest = worstOfStack(400);
  EXPECT_LE(rest.sink_m, kGaps_m);
  EXPECT_LE(rest.speed_m_s, 1e-3 * 9.81 * 1e-3);  // a thousandth of what gravity adds in a step
}

// A wall of more than twelve bodies, one of them heavy. With an earlier method this wall moved at 0.7 mm/s
// under a brick of fifty times the mass.
TEST(Solver, AWallOfBricksRestsUnderALightAndAHeavyBrick) {
  for (const double ratio : {1.0, 50.0, 1000.0}) {
    World world(SolverKind::Constraint);
    const Built brick = steelBox(), ground = plate();  // 20 x 15 x 10 mm
    Built top = brick;
    top.frame.mass_kg *= ratio;
    top.frame.inertia_kg_m2 *= ratio;
    world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
    std::vector<std::pair<btRigidBody*, double>> wall;  // each brick, and the height at which it was laid
    constexpr int kRows = 6;
    constexpr double kPitch_m = 0.0202, kHeight_m = 0.01;
    const auto lay = [&](const Built& built, double x_m, int row) {
      const double z_m = kHeight_m * (row + 0.5);
      wall.emplace_back(&world.add(built, Pose::translation(Vec3(x_m, 0, z_m))), z_m);
    };
    for (int row = 0; row < kRows; ++row)
      for (int k = 0; k < 3 - row % 2; ++k) lay(brick, kPitch_m * (k - 1 + 0.5 * (row % 2)), row);
    lay(top, 0, kRows);
    world.step(150);
    for (const auto& [body, laid_m] : wall) {
      EXPECT_NEAR(body->getWorldTransform().getOrigin().z(), laid_m,
                  (kRows + 1) * FeatureMotion::kRest_m + 1e-7)
          << ratio;
      // A thousandth of what gravity adds in a step; a hundredth under the heavy brick.
      EXPECT_LE(body->getLinearVelocity().length(), (ratio < 1000 ? 1e-3 : 1e-2) * 9.81 * 1e-3) << ratio;
    }
  }
}

TEST(Solver, ABodyWithAForceThatIsNotFiniteDoesNotAffectOthers) {
  World world;
  const Built box = steelBox(), ground = plate();
  world.add(ground, Pose::translation(Vec3(0, 0, -0.005)), true);
  btRigidBody& low = world.add(box, Pose::translation(Vec3(0, 0, 0.005)));
  btRigidBody& high = world.add(box, Pose::translation(Vec3(1e-4, 0, 0.015)));
  world.step(50);
  high.applyCentralForce(btVector3(0, 0, toBt(std::nan(""))));
  world.step();
  EXPECT_LE(low.getLinearVelocity().length(), 0.01);  // what gravity adds in one step
  EXPECT_NEAR(low.getWorldTransform().getOrigin().z(), 0.005, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Each, RestWithSolver,
                         testing::Values(SolverKind::Stock, SolverKind::Constraint, SolverKind::Penalty),
                         [](const auto& info) { return test::nameOf(info.param); });

TEST(Solver, RefusesSettingsWithWhichItCannotSolve) {
  EXPECT_THROW(Solver(SolverSettings{.iteration_limit = 0}), std::invalid_argument);
  EXPECT_THROW(Solver(SolverSettings{.residual_m_s = 0}), std::invalid_argument);
  EXPECT_THROW(Solver(SolverSettings{.residual_m_s = NAN}), std::invalid_argument);
  EXPECT_NO_THROW(Solver(SolverSettings{.iteration_limit = 1}));
}

// Bullet scales the friction along an axis of the body: mu g across it, a fifth of that along it.
TEST(Slide, AnisotropicFrictionIsThatOfBullet) {
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btBoxShape bullets(toBt(Vec3(0.01, 0.0075, 0.005)));
  const Built part = steelBox();
  for (const SolverKind solver : {SolverKind::Stock, SolverKind::Constraint})
    for (const bool is_part : {false, true})
      for (const int axis : {0, 1}) {
        World world(solver);
        btRigidBody& ground = world.addShape(plane, 0, Vec3::Zero(), Pose());
        const Pose X_WP = Pose::translation(Vec3(0, 0, 0.005));
        btRigidBody& body = is_part ? world.add(part, X_WP)
                                    : world.addShape(bullets, part.frame.mass_kg, Vec3(2, 3, 4) * 1e-7, X_WP);
        ground.setFriction(1);
        body.setFriction(toBt(0.5));
        // The body's axes are the principal ones: the axes of the box in another order.
        const Vec3 x_B = fromBt(body.getWorldTransform()).R.transpose() * Vec3::UnitX();
        body.setAnisotropicFriction(toBt(Vec3(Vec3::Ones() - 0.8 * x_B.cwiseAbs())));
        world.step(20);
        body.setLinearVelocity(toBt(Vec3(0.3 * Vec3::Unit(axis))));
        world.step(20);
        const double lost = 0.5 * kGravity * 0.02 * (axis == 0 ? 0.2 : 1);
        // The tolerance is one step, and the tilt of Bullet's own box.
        EXPECT_NEAR(body.getLinearVelocity()[axis], 0.3 - lost, 0.1 * lost) << is_part << axis;
      }
}

// The cubes' edges lie flush, and each point on an edge is as near to the side faces as to the face below.
TEST(Rest, EqualCubesStayExactlyAboveEachOther) {
  const double error_m = kIsDouble ? 1e-6 : 1e-5;  // 1e-5 is assumed
  for (const SolverKind solver : {SolverKind::Stock, SolverKind::Constraint})
    for (const double voxel_m : {0.25e-3, 0.5e-3}) {
      const Built cube = test::build(makeBox(Vec3::Constant(0.01)), 7850, voxel_m, 2 * voxel_m);
      for (const double gap_m : {0.0, 10e-6, 0.2e-3}) {
        World world(solver);
        world.add(cube, Pose(), true);
        for (int k = 1; k <= 3; ++k) world.add(cube, Pose::translation(Vec3(0, 0, k * (0.01 + gap_m))));
        world.step(300);
        for (int k = 1; k <= 3; ++k) {
          const btVector3 p = world.bodies[k]->getWorldTransform().getOrigin();
          EXPECT_LT(std::hypot(p.x(), p.y()), error_m) << gap_m << ' ' << k;
          EXPECT_NEAR(p.z(), 0.01 * k, 2 * error_m * k) << gap_m << ' ' << k;
        }
      }
    }
}

}  // namespace
}  // namespace vps::bullet
