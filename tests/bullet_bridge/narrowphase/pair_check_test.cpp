// SPDX-License-Identifier: BSD-3-Clause
// The check of a solved step: where two bodies would overlap at its end, and the share of the step during
// which they do not. The end poses are given; no solver is involved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_bridge/world.h"
#include "solver/contact_stores.h"
#include "solver/rigid/step_check.h"
#include "support/random_draw.h"
#include "vps/feature_motion.h"

namespace vps::bullet {
namespace {

using test::Built;

/// A fixed body and a moving one, after the narrow phase of a step.
struct CheckedPair {
  test::World world;
  Pose X_WB[2];  ///< of the fixed and of the moving body
  StepCheck* check = nullptr;

  void detect(btRigidBody& fixed, btRigidBody& other) {
    X_WB[0] = fromBt(fixed.getWorldTransform());
    X_WB[1] = fromBt(other.getWorldTransform());
    world.world->performDiscreteCollisionDetection();
    const ContactCreateFunction* stores = contactFunctionOf(&world.dispatcher);
    for (int i = 0; stores && i < world.dispatcher.getNumManifolds(); ++i)
      if (StepCheck* found = stores->step_checks->find(world.dispatcher.getManifoldByIndexInternal(i)))
        check = found;
    if (check && check->object(0) != &fixed) fixed_ = 1;
  }
  std::vector<MissedContact> missedAt(const Pose& X_end, CheckRound round = {}) {
    std::vector<MissedContact> missed;
    check->findMissed(Ends(*this, X_end).X_WB, round, missed);
    return missed;
  }
  double freeShareTo(const Pose& X_end) { return check->freeShare(Ends(*this, X_end).X_WB); }
  double freeShareOfPointsTo(const Pose& X_end) { return check->freeShareOfPoints(Ends(*this, X_end).X_WB); }

 private:
  /// The end poses in the check's order.
  struct Ends {
    Pose X_WB[2];
    Ends(const CheckedPair& pair, const Pose& X_end) {
      X_WB[pair.fixed_] = pair.X_WB[0];
      X_WB[1 - pair.fixed_] = X_end;
    }
  };
  int fixed_ = 0;  ///< which of the check's two bodies it is
};

/// A box above a plate.
struct BoxAbovePlate : CheckedPair {
  const Built& box = sharedBox();

  static const Built& sharedBox() {
    static const Built box = test::steelBox();
    return box;
  }
  static const Built& sharedPlate() {
    static const Built plate = test::plate();
    return plate;
  }
  /// @param gap_m  gap of the lowest corner
  BoxAbovePlate(const Mat3& R, double gap_m) {
    double lowest_m = 1e300;
    for (const Vec3& v : box.mesh.vertices) lowest_m = std::min(lowest_m, (R * v).z());
    btRigidBody& low = world.add(sharedPlate(), Pose::translation({0, 0, -5e-3}), true);
    btRigidBody& high = world.add(box, Pose(R, Vec3(0, 0, gap_m - lowest_m)));
    detect(low, high);
  }
  [[nodiscard]] Pose moved(const Vec3& by_W, const Vec3& turn = Vec3::Zero()) const {
    return {rotationFromVector(turn) * X_WB[1].R, X_WB[1].p + by_W};
  }
  /// By exact distance of the box's corners from the plate's face.
  [[nodiscard]] double depthAt(const Pose& X_end) const {
    double lowest_m = 1e300;
    for (const Vec3& v : box.mesh.vertices)
      lowest_m = std::min(lowest_m, (X_end * box.frame.X_PB.inverse() * v).z());
    return -lowest_m;
  }
};

TEST(PairCheck, MissesNothingInAStepThatStaysFree) {
  for (const double gap_m : {5e-6, 100e-6}) {
    BoxAbovePlate scene(Mat3::Identity(), gap_m);
    ASSERT_TRUE(scene.check);
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(0, 0, 1e-3), Vec3(2e-3, 0, 0), Vec3(0, 0, -0.5 * gap_m)}) {
      EXPECT_TRUE(scene.missedAt(scene.moved(by)).empty()) << gap_m << ' ' << by.transpose();
      EXPECT_EQ(scene.freeShareTo(scene.moved(by)), 1) << gap_m << ' ' << by.transpose();
    }
  }
}

// If a motion was found to be free of contact, a later motion from the same start is not checked if its end
// pose is within a twentieth of the rest gap (FeatureMotion::kRest_m) of the first motion's end pose. A
// motion that ends farther away is checked.
TEST(PairCheck, AClearWayHoldsForWaysThatEndBesideIt) {
  if (!test::kIsDouble) GTEST_SKIP() << "poses are coarser than a nanometre";
  constexpr double kGap_m = 100e-6, kMissed_m = FeatureMotion::kLeastShare * FeatureMotion::kRest_m;
  const auto missesAt = [&](BoxAbovePlate& scene, double gap_m) {
    return !scene.missedAt(scene.moved(Vec3(0, 0, gap_m - kGap_m))).empty();
  };
  BoxAbovePlate without(rotationFromVector({0.4, 0, 0}), kGap_m),
      with(rotationFromVector({0.4, 0, 0}), kGap_m);
  EXPECT_TRUE(missesAt(without, kMissed_m - 2e-9));
  EXPECT_FALSE(missesAt(with, kMissed_m + 2e-9));
  EXPECT_FALSE(missesAt(with, kMissed_m - 2e-9));
  EXPECT_TRUE(missesAt(with, kMissed_m - 4e-9));
}

// A box is moved from above a plate to below it, so that the path to the same end leads through the plate.
TEST(PairCheck, AClearWayHoldsFromItsStartOnly) {
  CheckedPair scene;
  btRigidBody& plate = scene.world.add(BoxAbovePlate::sharedPlate(), Pose::translation({0, 0, -5e-3}), true);
  btRigidBody& box = scene.world.add(BoxAbovePlate::sharedBox(), Pose::translation({0, 0, 5e-3 + 100e-6}));
  scene.detect(plate, box);
  ASSERT_TRUE(scene.check);
  const Pose X_end(scene.X_WB[1].R, scene.X_WB[1].p - Vec3(0, 0, 90e-6));
  EXPECT_TRUE(scene.missedAt(X_end).empty());
  box.setWorldTransform(toBt(Pose(X_end.R, X_end.p - Vec3(0, 0, 20e-3 + 110e-6))));
  scene.detect(plate, box);
  EXPECT_FALSE(scene.missedAt(X_end).empty());
}

// A motion that a later check of the step found free of contact was not checked for gaps that were small at
// the start.
TEST(PairCheck, AClearWayOfALaterRoundIsLookedAtForSmallGaps) {
  if (!test::kIsDouble) GTEST_SKIP() << "poses are coarser than a nanometre";
  BoxAbovePlate scene(rotationFromVector({0.4, 0.3, 0}), 15e-9);
  const Pose X_end = scene.moved({1e-6, 0, 0});
  EXPECT_TRUE(scene.missedAt(X_end, {1}).empty());
  EXPECT_FALSE(scene.missedAt(X_end).empty());
}

// One of Bullet's balls grows between two steps, while the part above it does not move.
TEST(PairCheck, AClearWayEndsWhereAShapeChangesItsSize) {
  constexpr double kRadius_m = 50e-3;
  btSphereShape ball(toBt(kRadius_m));
  CheckedPair scene;
  btRigidBody& fixed = scene.world.addShape(ball, 0, Vec3::Zero(), Pose::translation({0, 0, -kRadius_m}));
  btRigidBody& other = scene.world.add(BoxAbovePlate::sharedBox(), Pose::translation({0, 0, 5e-3 + 100e-6}));
  scene.detect(fixed, other);
  ASSERT_TRUE(scene.check);
  const Pose X_end(scene.X_WB[1].R, scene.X_WB[1].p - Vec3(0, 0, 90e-6));
  EXPECT_TRUE(scene.missedAt(X_end).empty());
  ball.setUnscaledRadius(toBt(kRadius_m + 50e-6));
  scene.detect(fixed, other);
  EXPECT_FALSE(scene.missedAt(X_end).empty());
}

// A corner, an edge or a face goes into the plate: the deepest contact that is reported has the exact depth.
TEST(PairCheck, ReportsTheExactDepthOfWhatGoesIn) {
  test::Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Mat3 R = i < 4    ? Mat3(Mat3::Identity())
                   : i < 12 ? rotationFromVector({0.4, 0, 0})
                            : random.rotation();
    BoxAbovePlate scene(R, random.uniform(10e-6, 100e-6));
    ASSERT_TRUE(scene.check);
    const Pose X_end = scene.moved(
        {random.uniform(-1e-4, 1e-4), random.uniform(-1e-4, 1e-4), -random.uniform(150e-6, 400e-6)},
        random.inBox(Vec3::Constant(2e-3)));
    const double depth_m = scene.depthAt(X_end);
    double deepest_m = 0;
    for (const MissedContact& m : scene.missedAt(X_end)) {
      deepest_m = std::max(deepest_m, -m.end_gap_m);
      ASSERT_TRUE(m.point);
      EXPECT_GT(std::abs(static_cast<double>(m.point->m_normalWorldOnB.z())), 0.999) << i;
    }
    EXPECT_NEAR(deepest_m, depth_m, 2e-6) << i;
  }
}

// The share of the step that is free of contact ends shortly before the corner touches the face.
TEST(PairCheck, TheFreeShareEndsWhereACornerMeetsTheFace) {
  test::Random random(2);
  for (int i = 0; i < 40; ++i) {
    const double gap_m = random.uniform(20e-6, 100e-6), way_m = random.uniform(150e-6, 400e-6);
    BoxAbovePlate scene(random.rotation(), gap_m);
    ASSERT_TRUE(scene.check);
    const double share = scene.freeShareTo(scene.moved({0, 0, -way_m}));
    EXPECT_LE(share, gap_m / way_m * (1 + 1e-6)) << i;
    EXPECT_GE(share, 0.9 * gap_m / way_m - 1e-6 / way_m) << i;
  }
}

/// A ball in a bore. The step moves the ball along the wall to a pose with a given overlap. The points of
/// both parts are 1.3 mm apart.
struct BallInBore : CheckedPair {
  static constexpr double kBall_m = 4e-3, kBore_m = 5e-3;
  const Built& built = sharedBall();

  static const Built& sharedBall() {
    static const Built ball = test::build(makeSphere(kBall_m, 4), 7850, 0.5e-3, 1.3e-3);
    return ball;
  }
  static const Built& sharedTube() {
    static const Built tube = test::build(makeTube(10e-3, kBore_m, 20e-3, 128), 7850, 0.5e-3, 1.3e-3);
    return tube;
  }
  BallInBore(const Mat3& R, const Vec3& at, const Vec3& v) {
    world.world->setGravity(btVector3(0, 0, 0));
    btRigidBody& low = world.add(sharedTube(), Pose(), true);
    btRigidBody& high = world.add(built, Pose(R, at));
    high.clearForces();
    high.setLinearVelocity(toBt(v));
    detect(low, high);
  }
  [[nodiscard]] double deepestAt(const Pose& X_end) {
    double deepest_m = 0;
    for (const MissedContact& m : missedAt(X_end)) deepest_m = std::max(deepest_m, -m.end_gap_m);
    return deepest_m;
  }
  [[nodiscard]] double depthAt(const Pose& X_end) const {
    return test::penetration_m(built, X_end * built.frame.X_PB.inverse(), sharedTube(), Pose());
  }
};

// The ball moves along a concave wall by more than a facet. Planes of the points known before the step
// predict room, and all points may be farther away than the faces between them.
TEST(PairCheck, ReportsWhatGoesInBetweenThePointsOfCurvedFaces) {
  test::Random random(3);
  const double play_m = BallInBore::kBore_m - BallInBore::kBall_m;
  for (int i = 0; i < 40; ++i) {
    const double angle_rad = random.uniform(0, 6), turn_rad = random.uniform(0.15, 0.3);
    const auto at = [&](double a, double r) { return Vec3(r * std::cos(a), r * std::sin(a), 0); };
    const Vec3 from = at(angle_rad, play_m - 4e-6),
               to = at(angle_rad + turn_rad, play_m + random.uniform(6e-6, 12e-6));
    BallInBore scene(random.rotation(), from, (at(angle_rad + turn_rad, play_m + 0.03e-3) - from) / 1e-3);
    ASSERT_TRUE(scene.check);
    const Pose X_end(scene.X_WB[1].R, scene.X_WB[1].p + to - from);
    EXPECT_NEAR(scene.deepestAt(X_end), scene.depthAt(X_end), 6e-6) << i;  // of facets
  }
}

// The ball turns to another side before each check, until the manifolds are full. The overlap must still be
// reported as missed.
TEST(PairCheck, SaysWhatItMissesAlsoWithoutRoom) {
  const double play_m = BallInBore::kBore_m - BallInBore::kBall_m;
  BallInBore scene(Mat3::Identity(), {play_m - 4e-6, 0, 0}, Vec3::Zero());
  ASSERT_TRUE(scene.check);
  test::Random random(5);
  bool was_full = false;
  for (int i = 0; i < 60; ++i) {
    const std::vector<MissedContact> missed =
        scene.missedAt({random.rotation(), Vec3(play_m + 40e-6, 0, random.uniform(-4e-3, 4e-3))});
    EXPECT_FALSE(missed.empty()) << i;
    for (const MissedContact& m : missed) was_full = was_full || m.point == nullptr;
  }
  EXPECT_TRUE(was_full);
}

// A ball flies into the wall. At the end of the free share the ball is at most 10 um deep, and not much less.
TEST(PairCheck, TheFreeShareOfPointsEndsWhereTheyAreDeep) {
  test::Random random(4);
  const double play_m = BallInBore::kBore_m - BallInBore::kBall_m, allowed_m = 10e-6;
  for (int i = 0; i < 40; ++i) {
    const double angle_rad = random.uniform(0, 6), gap_m = random.uniform(5e-6, 0.3e-3),
                 depth_m = random.uniform(20e-6, 60e-6);
    const Vec3 out(std::cos(angle_rad), std::sin(angle_rad), 0);
    BallInBore scene(random.rotation(), (play_m - gap_m) * out, (gap_m + depth_m) / 1e-3 * out);
    ASSERT_TRUE(scene.check);
    const auto posesAt = [&](double share) {
      return Pose(scene.X_WB[1].R, scene.X_WB[1].p + share * (gap_m + depth_m) * out);
    };
    const double share = scene.freeShareOfPointsTo(posesAt(1));
    ASSERT_LT(share, 1) << i;
    EXPECT_NEAR(scene.depthAt(posesAt(share)), allowed_m, 4e-6) << i;
    EXPECT_EQ(scene.freeShareOfPointsTo(posesAt(0.9 * share)), 1) << i;
  }
}

// A body that is deep before the step may move a little, so that it is not held for ever.
TEST(PairCheck, TheFreeShareOfWhatIsDeepIsNotZero) {
  const double play_m = BallInBore::kBore_m - BallInBore::kBall_m;
  BallInBore scene(Mat3::Identity(), Vec3(play_m + 15e-6, 0, 0), Vec3(50e-3, 0, 0));
  ASSERT_TRUE(scene.check);
  const Pose X_end(scene.X_WB[1].R, scene.X_WB[1].p + Vec3(50e-6, 0, 0));
  const double share = scene.freeShareOfPointsTo(X_end);
  EXPECT_GT(share, 0.01);
  EXPECT_LT(share * 50e-6, 2e-6);
}

// The check is not valid until the narrow phase has visited the pair again.
TEST(PairCheck, IsSilentAfterTheEndOfItsStep) {
  BoxAbovePlate scene(Mat3::Identity(), 50e-6);
  ASSERT_TRUE(scene.check);
  scene.check->endStep();
  EXPECT_TRUE(scene.missedAt(scene.moved({0, 0, -300e-6})).empty());
}

}  // namespace
}  // namespace vps::bullet
