// SPDX-License-Identifier: BSD-3-Clause
// Edges that cross edges between their shell points.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::build;
using test::Built;
using test::SolverKind;
using test::World;

constexpr double kWidth_m = 2e-3,
                 kHalf_m = kWidth_m * std::numbers::sqrt2 / 2;  // of a bar; from axis to edge

Mesh turned(Mesh mesh, const Vec3& axis, const Vec3& by) {
  const Mat3 R = rotationFromVector(axis * (std::numbers::pi / 4));
  for (Vec3& v : mesh.vertices) v = R * v + by;
  return mesh;
}

// Two parallel bars, each resting on an edge, as one part. No dimension is a multiple of another, so that
// points of two edges do not coincide.
Built bars(bool along_x) {
  const Vec3 size = along_x ? Vec3(31.3e-3, kWidth_m, kWidth_m) : Vec3(kWidth_m, 29.7e-3, kWidth_m);
  const Vec3 axis = along_x ? Vec3::UnitX() : Vec3::UnitY(), aside = along_x ? Vec3::UnitY() : Vec3::UnitX();
  Mesh mesh = turned(makeBox(size), axis, 7.77e-3 * aside);
  append(mesh, turned(makeBox(size), axis, -8.13e-3 * aside));
  return build(mesh, 7850);
}

// Upper bars across lower ones; the lower bars' upper edges are at z = 0.
struct Crossed {
  explicit Crossed(double gap_m, SolverKind solver = SolverKind::Constraint) : world(solver) {
    ground = &world.add(lower, Pose::translation({0, 0, -kHalf_m}), true, 0.3);
    body = &world.add(upper, Pose::translation({0.31e-3, 0.17e-3, kHalf_m + gap_m}), false, 0.3);
  }
  Built lower = bars(false), upper = bars(true);
  World world;
  btRigidBody *ground = nullptr, *body = nullptr;
};

struct Points : btCollisionWorld::ContactResultCallback {
  double least_m = 1, most_m = -1;
  int count = 0;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    least_m = std::min<double>(least_m, point.getDistance());
    most_m = std::max<double>(most_m, point.getDistance());
    ++count;
    return 0;
  }
};

TEST(Crossing, OfFourEdgesIsFoundWithItsGap) {
  Crossed scene(12e-6);
  Points seen;
  seen.m_closestDistanceThreshold = toBt(20e-6);
  scene.world.world->contactPairTest(scene.ground, scene.body, seen);
  EXPECT_EQ(seen.count, 4);
  // A float resolves a height of 1 mm to 1e-10 m, and the distance is a difference of several heights.
  EXPECT_NEAR(seen.least_m, 12e-6, 1e-9);
  EXPECT_NEAR(seen.most_m, 12e-6, 1e-9);
}

TEST(Crossing, SupportsAPartThatTouchesNowhereElse) {
  constexpr double kGap_m = 50e-6;
  Crossed scene(kGap_m);
  const Vec3 start = fromBt(scene.body->getWorldTransform().getOrigin());
  scene.world.step(1000);
  const Vec3 moved = fromBt(scene.body->getWorldTransform().getOrigin()) - start;
  // The part descends by the gap and no farther. An overlap below 1 um, which the contact margin may leave,
  // is not removed.
  EXPECT_NEAR(moved.z(), -kGap_m, 1e-6);
  EXPECT_LT(moved.head<2>().norm(), 1e-6);
  const double speed_m_s = fromBt(scene.body->getLinearVelocity()).norm();
  EXPECT_LE(speed_m_s, 1e-6);
}

TEST(Crossing, SlidesOverShellPointsWithoutAJolt) {
  // The part is pushed along the lower bars at 20 mm/s: points of both edges pass each other continuously,
  // without any effect on its motion.
  Crossed scene(0);
  scene.body->setFriction(0);
  scene.world.step(100);
  scene.body->setLinearVelocity({0, toBt(0.02), 0});
  double least_m = 1, most_m = -1, slowest_m_s = 1;
  for (int i = 0; i < 100; ++i) {
    scene.world.step();
    const double z_m = scene.body->getWorldTransform().getOrigin().z();
    least_m = std::min(least_m, z_m);
    most_m = std::max(most_m, z_m);
    slowest_m_s = std::min<double>(slowest_m_s, scene.body->getLinearVelocity().y());
  }
  EXPECT_LT(most_m - least_m, 1e-6);
  EXPECT_GT(slowest_m_s, 0.02 * (1 - 1e-3));
}

// A peg that has gone into its hole by far less than a voxel: rims face each other on a narrow strip, where
// the field, which rounds edges off, reads up to 0.4 voxels more than the gap. The rims lie along each other,
// so that no edges cross.
TEST(Rims, ThatFaceEachOtherOnANarrowStripHoldAPeg) {
  constexpr double kRadius_m = 5.12e-3, kGap_m = 10e-6, kHigh_m = 10.25e-3;
  for (const double into_m : {10e-6, 30e-6, 60e-6}) {
    World world(SolverKind::Constraint);
    const Built hole = build(makeTube(9e-3, kRadius_m + kGap_m, kHigh_m, 96), 7850),
                peg = build(makeCylinder(kRadius_m, kHigh_m, 96), 7850);
    world.add(hole, Pose(), true, 0.3);
    btRigidBody& body = world.add(peg, Pose::translation({0, 0, kHigh_m - into_m}), false, 0.3);
    body.setGravity({0, 0, 0});
    body.setAngularFactor(0);
    const Vec3 start = fromBt(body.getWorldTransform().getOrigin());
    body.setLinearVelocity({toBt(-0.0012), toBt(-0.0016), 0});
    double most_m = 0;
    for (int i = 0; i < 40; ++i) {
      world.step();
      most_m = std::max(most_m, (fromBt(body.getWorldTransform().getOrigin()) - start).norm());
    }
    // Polygons of 96 sides meet with a side on a side, or 0.3 um later with a corner on a side.
    EXPECT_NEAR(most_m, kGap_m, 1e-6) << into_m;
  }
}

TEST(Crossing, OfASquarePegsRimDoesNotKeepItOutOfItsHole) {
  // 10 um of clearance on each side, sharp edges everywhere: when the peg is inside, its lower rim is below
  // the hole's.
  constexpr double kPeg_m = 8e-3, kClear_m = 10e-6, kHole_m = kPeg_m + 2 * kClear_m, kDeep_m = 6e-3;
  Mesh frame;
  const double wall_m = 4e-3, out_m = kHole_m / 2 + wall_m / 2;
  const auto add = [&](const Vec3& size, const Vec3& at) {
    Mesh part = makeBox(size);
    for (Vec3& v : part.vertices) v += at;
    append(frame, part);
  };
  add({wall_m, kHole_m, kDeep_m}, {out_m, 0, -kDeep_m / 2});
  add({wall_m, kHole_m, kDeep_m}, {-out_m, 0, -kDeep_m / 2});
  add({kHole_m + 2 * wall_m, wall_m, kDeep_m}, {0, out_m, -kDeep_m / 2});
  add({kHole_m + 2 * wall_m, wall_m, kDeep_m}, {0, -out_m, -kDeep_m / 2});
  const Built hole = build(frame, 7850), peg = build(makeBox({kPeg_m, kPeg_m, 10e-3}), 7850);
  World world(SolverKind::Constraint);
  world.add(hole, Pose(), true, 0.0);
  btRigidBody& body = world.add(peg, Pose::translation({0, 0, 5e-3 + 20e-6}), false, 0.0);
  for (int i = 1; i <= 30; ++i) {
    world.step();
    // Free fall, with 1 % for contacts on the way; Bullet adds g dt before it moves.
    const double fallen_m = 0.5 * test::kGravity * 1e-6 * i * (i + 1);
    EXPECT_NEAR(5e-3 + 20e-6 - body.getWorldTransform().getOrigin().z(), fallen_m, 0.01 * fallen_m + 1e-7);
  }
}

}  // namespace
}  // namespace vps::bullet
