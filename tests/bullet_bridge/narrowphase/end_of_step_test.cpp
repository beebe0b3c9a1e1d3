// SPDX-License-Identifier: BSD-3-Clause
// The gaps that sliding contacts of curved faces have at the end of the step in free motion, compared with
// formulas for balls, bores and cylinders.
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "bullet_bridge/world.h"
#include "narrowphase/selection/contact_selection.h"

namespace vps::bullet {
namespace {

using test::Built;

constexpr double kStep_s = 1e-3, kMargin_m = 20e-6, kSpacing_m = 0.5e-3;
constexpr double kBall_m = 4e-3, kBore_m = 5e-3, kShaft_m = 10e-3;
// Facets of the ball are up to 1.2 um inside it, those of the bore and the shaft up to 0.8.
constexpr double kFacets_m = 2.4e-6;

const Built& ball() {
  static const Built built = test::build(makeSphere(kBall_m, 5), 7850, 0.25e-3, kSpacing_m);
  return built;
}
const Built& bore() {
  static const Built built = test::build(makeTube(8e-3, kBore_m, 12e-3, 256), 7850, 0.25e-3, kSpacing_m);
  return built;
}
const Built& shaft() {
  static const Built built = test::build(makeCylinder(kShaft_m, 12e-3, 512), 7850, 0.25e-3, kSpacing_m);
  return built;
}
const Built& thickPlate() {
  static const Built built = test::build(makeBox(Vec3(30e-3, 30e-3, 6e-3)), 7850, 0.25e-3, kSpacing_m);
  return built;
}

/// A ball beside a part, about the axis z of W, with velocities.
struct Scene {
  test::World world;
  btRigidBody &high, &low;
  btTransform X_high, X_low;
  btCollisionObjectWrapper wrapper0, wrapper1;
  PairView pair;
  Settings settings;
  RelativeMotion motion;
  std::vector<Candidate> now, then;  ///< the same contacts, before and after they were measured

  Scene(const Built& part, const Vec3& center, const Vec3& v_high, const Vec3& v_low = Vec3::Zero(),
        const Vec3& w_high = Vec3::Zero())
      : high(world.add(ball(), Pose::translation(center))),
        low(world.add(part, Pose())),
        X_high(high.getWorldTransform()),
        X_low(low.getWorldTransform()),
        wrapper0(nullptr, ball().shape.get(), &high, X_high, -1, -1),
        wrapper1(nullptr, part.shape.get(), &low, X_low, -1, -1),
        pair(&wrapper0, &wrapper1) {
    for (btRigidBody* body : {&high, &low}) body->clearForces();
    high.setLinearVelocity(toBt(v_high));
    high.setAngularVelocity(toBt(w_high));
    low.setLinearVelocity(toBt(v_low));
    motion = relativeMotion(pair, kStep_s, kMargin_m, false);
    for (int i = 0; i < 2; ++i) addNear(i, i == 0 ? ball() : part, i == 0 ? part : ball());
    refineAll(pair, motion, settings, now);
    then = now;
    measureAtEnd(pair, motion, settings, then);
  }
  // Points of opposite faces near the place where the bodies are nearest.
  void addNear(int i, const Built& own, const Built& other) {
    const SideView side = pair.side(i), their = pair.side(1 - i);
    for (std::uint32_t id = 0; id < own.shape->models().shell->size(); ++id) {
      Candidate c;
      c.side = static_cast<std::uint8_t>(i);
      c.id = id;
      c.p_W = side.X_WM * own.shape->models().shell->points[id];
      c.distance_m = other.exact->signedDistance(their.X_WM.inverse() * c.p_W);
      if (c.distance_m < 30e-6 && !own.shape->isEdgePoint(id)) now.push_back(c);
    }
  }
  /// The gap at the end of the step that the solver will use.
  [[nodiscard]] double end_m(const Candidate& c) const {
    return c.distance_m + kStep_s * c.n_W.dot(motion.velocityAt(c.p_W));
  }
  // A contact at the nearest place of both surfaces, before and after the step, has the formula's gap; other
  // contacts have larger gaps.
  void expectGapAtEnd(double gap_m) const {
    int near = 0;
    for (std::size_t k = 0; k < then.size(); ++k) {
      EXPECT_EQ(then[k].p_W, now[k].p_W);
      EXPECT_EQ(then[k].n_W, now[k].n_W);
      if (then[k].distance_m == now[k].distance_m) continue;
      EXPECT_GE(end_m(then[k]), gap_m - kFacets_m) << now[k].side + 0 << ' ' << now[k].id;
      near += end_m(then[k]) < gap_m + kFacets_m;
    }
    EXPECT_GE(near, 2);
  }
  void expectUnchanged() const {
    EXPECT_GE(then.size(), 2U);
    for (std::size_t k = 0; k < then.size(); ++k) EXPECT_EQ(then[k].distance_m, now[k].distance_m) << k;
  }
};

// A ball of 4 mm slides in a bore of 5 mm: its centre leaves the circle on which it may be by a parabola, 11
// um.
TEST(EndOfStep, AHollowFaceIsNearerThanItsPlane) {
  const double way_m = 0.15e-3, play_m = kBore_m - kBall_m;
  for (const double angle_rad : {0.3, 1.1, 4.0}) {
    const Vec3 out(std::cos(angle_rad), std::sin(angle_rad), 0), along(-out.y(), out.x(), 0);
    const Scene scene(bore(), play_m * out, way_m / kStep_s * along);
    scene.expectGapAtEnd(play_m - std::hypot(play_m, way_m));
  }
}

// The same test with a moving bore and a ball at rest.
TEST(EndOfStep, EitherBodyMayBeTheOneThatMoves) {
  const double way_m = 0.15e-3, play_m = kBore_m - kBall_m;
  const Scene scene(bore(), Vec3(play_m, 0, 0), Vec3::Zero(), Vec3(0, -way_m / kStep_s, 0));
  scene.expectGapAtEnd(play_m - std::hypot(play_m, way_m));
}

// On a shaft the ball leaves the contact plane.
TEST(EndOfStep, ARoundFaceIsFartherThanItsPlane) {
  const double way_m = 0.5e-3, apart_m = kShaft_m + kBall_m;
  const Scene scene(shaft(), Vec3(apart_m, 0, 0), Vec3(0, way_m / kStep_s, 0));
  scene.expectGapAtEnd(std::hypot(apart_m, way_m) - apart_m);
}

// The gap of a ball that spins in place does not depend on the facet that faces the contact.
TEST(EndOfStep, ASpinningBallKeepsItsGap) {
  const Scene scene(shaft(), Vec3(kShaft_m + kBall_m, 0, 0), Vec3::Zero(), Vec3::Zero(), Vec3(0, 0, 30));
  scene.expectGapAtEnd(0);
}

TEST(EndOfStep, OnAFlatFaceItsPlaneSaysAll) {
  const Scene scene(thickPlate(), Vec3(1e-3, 2e-3, 3e-3 + kBall_m), Vec3(0.3, 0.1, 0));
  for (std::size_t k = 0; k < scene.then.size(); ++k)
    if (scene.now[k].plane_of == 1) {
      EXPECT_EQ(scene.then[k].distance_m, scene.now[k].distance_m);
    }
}

// A contact at which the bodies collide, instead of sliding along it, is not measured at the end of free
// motion. A contact whose displacement is within the margin cannot leave a plane, and is not measured either.
TEST(EndOfStep, WhatMeetsAFaceOrHardlyMovesKeepsItsPlane) {
  const double play_m = kBore_m - kBall_m;
  Scene(bore(), Vec3(play_m, 0, 0), Vec3(0.1, 0.1, 0)).expectUnchanged();
  Scene(bore(), Vec3(play_m, 0, 0), Vec3(0, 15e-6 / kStep_s, 0)).expectUnchanged();
}

// The point is so deep at the end that contact will have turned the body, and another place will count.
TEST(EndOfStep, WhatWouldEndDeepKeepsItsPlane) {
  const Scene scene(bore(), Vec3(kBore_m - kBall_m, 0, 0), Vec3(0, 0.8e-3 / kStep_s, 0));
  EXPECT_GE(scene.then.size(), 2U);
  for (std::size_t k = 0; k < scene.then.size(); ++k)
    if (scene.then[k].distance_m != scene.now[k].distance_m) {
      EXPECT_LT(std::abs(scene.end_m(scene.then[k])), std::abs(scene.now[k].distance_m) + kMargin_m) << k;
    }
}

}  // namespace
}  // namespace vps::bullet
